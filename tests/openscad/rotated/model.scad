difference() {
  rotate([30, 20, 10]) cube([20, 10, 5]);
  rotate([0, 90, 0]) translate([0, 0, -30]) cylinder(r = 3, h = 60, $fn = 10);
}
