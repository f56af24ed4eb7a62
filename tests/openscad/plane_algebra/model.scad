linear_extrude(height = 2.5) difference() {
  intersection() {
    circle(r = 14, $fn = 40);
    square([24, 40], center = true);
  }
  translate([0, 3]) circle(r = 3, $fn = 20);
  translate([0, -3]) square([2.5, 10], center = true);
  for (y = [-10, 10]) translate([0, y]) circle(r = 1.5, $fn = 12);
}
