cylinder(r1 = 10, r2 = 4, h = 15, $fn = 20);
