difference() {
  cube(27, center = true);
  for (turn = [[0, 0, 0], [90, 0, 0], [0, 90, 0]]) rotate(turn) {
    cube([9, 9, 29], center = true);
    for (x = [-9, 0, 9], y = [-9, 0, 9]) translate([x, y, 0]) cube([3, 3, 29], center = true);
  }
}
