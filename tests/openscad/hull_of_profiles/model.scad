linear_extrude(height = 6) difference() {
  hull() {
    circle(r = 8, $fn = 32);
    translate([30, 0]) circle(r = 5, $fn = 32);
  }
  circle(r = 4, $fn = 24);
  translate([30, 0]) circle(r = 2.5, $fn = 24);
}
