module gusset() { rotate([90, 0, 0]) linear_extrude(height = 3) polygon([[4, 4], [24, 4], [4, 24]]); }
difference() {
  union() {
    translate([0, -20, 0]) cube([40, 40, 4]);
    translate([0, -20, 0]) cube([4, 40, 40]);
    translate([0, -13, 0]) gusset();
    translate([0, 16, 0]) gusset();
  }
  for (y = [-7, 7]) translate([30, y, -1]) cylinder(d = 5.5, h = 6, $fn = 20);
  for (y = [-7, 7]) translate([-1, y, 30]) rotate([0, 90, 0]) cylinder(d = 5.5, h = 6, $fn = 20);
}
