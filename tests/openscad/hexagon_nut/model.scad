difference() {
  cylinder(d = 17 / cos(30), h = 8, $fn = 6);
  translate([0, 0, -1]) cylinder(d = 10, h = 10, $fn = 36);
}
