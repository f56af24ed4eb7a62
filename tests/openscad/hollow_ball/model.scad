difference() {
  sphere(r = 12, $fn = 20);
  cube(8, center = true);
}
