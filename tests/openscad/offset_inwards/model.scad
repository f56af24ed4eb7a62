difference() {
  linear_extrude(height = 20) circle(r = 18, $fn = 6);
  translate([0, 0, 2]) linear_extrude(height = 20) offset(r = -2) circle(r = 18, $fn = 6);
}
