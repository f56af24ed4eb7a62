use <../../../assets/fonts/LiberationSans-Regular.ttf>
linear_extrude(height = 2) text("HIKE", size = 12, font = "Liberation Sans");
