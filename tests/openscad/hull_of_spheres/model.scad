module ball() { sphere(r = 5, $fn = 16); }
hull() {
  ball();
  translate([22, 0, 0]) ball();
  translate([10, 15, 4]) ball();
}
