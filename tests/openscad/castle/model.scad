difference() {
  cylinder(r = 20, h = 16, $fn = 36);
  translate([0, 0, 2]) cylinder(r = 16, h = 15, $fn = 36);
  for (i = [0:8]) rotate([0, 0, 40 * i]) translate([14, -2, 12]) cube([8, 4, 5]);
  rotate([0, 0, 20]) translate([14, -3, 2]) cube([8, 6, 6]);
}
