use <../../../assets/fonts/LiberationSans-Regular.ttf>
difference() {
  translate([-22, -9, 0]) cube([44, 18, 3]);
  translate([0, 0, 2]) linear_extrude(height = 2)
    text("FIXE", size = 10, font = "Liberation Sans", halign = "center", valign = "center");
}
