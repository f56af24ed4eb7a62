module ring() { rotate([0, 0, 180]) rotate_extrude($fn = 18) translate([12, 0]) circle(r = 2.5, $fn = 18); }
ring();
translate([12, 0, 0]) rotate([90, 0, 0]) ring();
