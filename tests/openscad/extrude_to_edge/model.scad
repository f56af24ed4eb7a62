linear_extrude(height = 9, scale = [0.25, 1]) square([20, 12], center = true);
