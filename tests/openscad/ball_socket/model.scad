difference() {
  intersection() {
    difference() {
      sphere(r = 14, $fn = 32);
      sphere(r = 11, $fn = 32);
    }
    translate([-20, -20, -20]) cube([40, 40, 20]);
  }
  translate([-2.5, -20, -8]) cube([5, 40, 9]);
}
