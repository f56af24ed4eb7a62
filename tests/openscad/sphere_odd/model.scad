sphere(d = 18, $fn = 15);
