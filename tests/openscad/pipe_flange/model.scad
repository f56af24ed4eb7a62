difference() {
  union() {
    cylinder(d = 60, h = 8, $fn = 48);
    cylinder(d = 32, h = 20, $fn = 48);
  }
  translate([0, 0, -1]) cylinder(d = 24, h = 22, $fn = 48);
  for (i = [0:5]) rotate([0, 0, 60 * i]) translate([23, 0, -1]) cylinder(d = 7, h = 10, $fn = 16);
}
