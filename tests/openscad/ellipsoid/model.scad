scale([1.5, 1, 0.6]) sphere(r = 10, $fn = 20);
