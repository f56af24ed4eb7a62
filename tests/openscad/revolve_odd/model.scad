rotate([0, 0, 180]) rotate_extrude($fn = 7)
  translate([11, 2]) square([4, 9], center = true);
