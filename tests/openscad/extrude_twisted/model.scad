// twist turns the other way in OpenSCAD
linear_extrude(height = 30, twist = -60, slices = 11) square([20, 12], center = true);
