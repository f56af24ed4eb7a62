cylinder(r = 8, h = 12, $fn = 7);
