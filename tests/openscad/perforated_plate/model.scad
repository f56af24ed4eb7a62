difference() {
  translate([-25, -16, 0]) cube([50, 32, 3]);
  for (x = [-20:8:20], y = [-12:8:12]) translate([x, y, -1]) cylinder(d = 4, h = 5, $fn = 12);
}
