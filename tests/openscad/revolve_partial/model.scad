rotate_extrude(angle = 270, $fn = 24) translate([20, 0]) square([3, 8], center = true);
