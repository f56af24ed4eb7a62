sphere(r = 10, $fn = 22);
translate([0, 0, 13]) sphere(r = 7, $fn = 22);
translate([0, 0, 22]) sphere(r = 5, $fn = 22);
translate([4, 0, 22]) rotate([0, 90, 0]) cylinder(r1 = 1.2, r2 = 0, h = 6, $fn = 9);
