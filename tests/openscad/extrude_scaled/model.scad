linear_extrude(height = 25, scale = 0.5) difference() {
  square([20, 12], center = true);
  circle(r = 3, $fn = 16);
}
