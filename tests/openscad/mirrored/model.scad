module hook() {
  cube([18, 5, 8]);
  translate([13, 0, 0]) cube([5, 16, 8]);
  translate([6, 2.5, 0]) cylinder(r = 3, h = 12, $fn = 18);
}
hook();
mirror([1, 0, 0]) hook();
