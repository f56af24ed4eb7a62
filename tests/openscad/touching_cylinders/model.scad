union() {
  difference() {
    translate([-15, -10, 0]) cube([30, 20, 10]);
    translate([0, 0, -1]) cylinder(r = 6, h = 12, $fn = 30);
  }
  cylinder(r = 6, h = 16, $fn = 30);
}
