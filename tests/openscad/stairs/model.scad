for (i = [0:4]) translate([8 * i, 0, 0]) cube([8, 20, 5 * (i + 1)]);
