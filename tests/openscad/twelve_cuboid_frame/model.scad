for (a = [-12, 12], b = [-12, 12]) {
  translate([0, a, b]) cube([30, 6, 6], center = true);
  translate([a, 0, b]) cube([6, 30, 6], center = true);
  translate([a, b, 0]) cube([6, 6, 30], center = true);
}
