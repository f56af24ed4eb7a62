difference() {
  union() {
    intersection() {
      difference() {
        translate([-15, -15, 0]) cube([30, 30, 20]);
        translate([0, 0, -1]) cylinder(r = 8, h = 22, $fn = 24);
      }
      translate([0, 0, 10]) sphere(r = 19, $fn = 24);
    }
    translate([0, 0, 20]) difference() {
      cylinder(r = 12, h = 4, $fn = 24);
      translate([0, 0, -1]) cylinder(r = 10, h = 6, $fn = 24);
    }
  }
  translate([-2, -30, 18]) cube([4, 60, 6]);
}
