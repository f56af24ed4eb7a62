module rod() { translate([0, 0, -12]) cylinder(r = 10, h = 24, $fn = 24); }
intersection() {
  rod();
  rotate([90, 0, 0]) rod();
  rotate([0, 90, 0]) rod();
}
