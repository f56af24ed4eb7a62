rotate_extrude(angle = 60, $fn = 36) polygon([[0, 0], [25, 0], [25, 6], [0, 8]]);
