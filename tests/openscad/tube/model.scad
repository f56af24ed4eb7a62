difference() {
  cylinder(d = 20, h = 15, $fn = 48);
  translate([0, 0, -1]) cylinder(d = 14, h = 17, $fn = 48);
}
