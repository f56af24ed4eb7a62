difference() {
  cube([40, 24, 8]);
  translate([5, 5, 4]) cube([10, 14, 4]);
  translate([20, 0, 0]) cube([6, 12, 8]);
  translate([32, 16, 0]) cube([8, 8, 8]);
}
