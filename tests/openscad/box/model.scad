translate([-20, -15, 0]) cube([40, 30, 5]);
