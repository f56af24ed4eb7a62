hull() {
  translate([-15, -15, 0]) cube([30, 30, 2]);
  translate([0, 0, 20]) cylinder(r = 9, h = 2, $fn = 28);
}
