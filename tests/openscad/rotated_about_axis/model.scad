intersection() {
  rotate(a = 47, v = [1, 1, 1]) translate([-6, -6, 0]) cube([12, 12, 12]);
  translate([0, 0, 6]) sphere(r = 9, $fn = 18);
}
