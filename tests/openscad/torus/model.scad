rotate([0, 0, 180]) rotate_extrude($fn = 16) translate([15, 0]) circle(r = 4, $fn = 16);
