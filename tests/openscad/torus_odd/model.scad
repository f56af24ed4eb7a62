rotate([0, 0, 180]) rotate_extrude($fn = 9) translate([12, 0]) circle(r = 5, $fn = 9);
