cylinder(r1 = 9, r2 = 0, h = 14, $fn = 13);
translate([0, 0, -6]) cylinder(d1 = 0, d2 = 18, h = 6, $fn = 13);
