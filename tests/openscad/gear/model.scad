module bore() {
  circle(r = 4, $fn = 24);
  translate([4, 0]) square([3, 3], center = true);
}
linear_extrude(height = 6) difference() {
  union() {
    circle(r = 18, $fn = 64);
    for (i = [0:15]) rotate(22.5 * i) polygon([[17, -2.4], [22, -1.1], [22, 1.1], [17, 2.4]]);
  }
  bore();
}
linear_extrude(height = 10) difference() {
  circle(r = 8, $fn = 32);
  bore();
}
