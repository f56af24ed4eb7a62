multmatrix([[1, 0, 0.4, 3], [0.1, 1, 0.2, -2], [0, 0, 1.5, 1], [0, 0, 0, 1]]) difference() {
  translate([-8, -5, 0]) cube([16, 10, 8]);
  translate([0, 0, -1]) cylinder(r = 3, h = 10, $fn = 14);
}
