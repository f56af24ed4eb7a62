linear_extrude(height = 24, twist = 75, scale = 0.5, slices = 6) {
  square([16, 5], center = true);
  square([5, 16], center = true);
}
