//! Views of surfaces, figures on faces and free lines as the language says them, with lengths that follow from the model.

use katachi::{
    base::{Shelf, watch::Unwatched},
    session::Session,
};

use super::scenes::near;

/// Visible and hidden length of the views of a model, in their order.
fn lengths(text: &str) -> Vec<[f64; 2]> {
    let files = [("model.kata", text)];
    let shelf = Shelf(&files);
    let session = Session::new(&shelf, &Unwatched, None);
    let (mut model, mut diagnostics) = session.compile("model.kata", &[]);
    let measured = model.measure(&[]);
    diagnostics.extend(measured.diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    measured.views.iter().map(|(_, lines)| [lines.visible, lines.hidden]).collect()
}

fn agree(found: [f64; 2], known: [f64; 2]) {
    let fits = (0..2).all(|i| near(found[i], known[i], 1e-6));
    assert!(fits, "{found:?}, not {known:?}");
}

#[test]
fn surfaces_are_drawn_by_their_grid_lines() {
    let found = lengths(
        "flat = graph((x, y) => 3mm, x = 0..4, y = 0..6, n = [2, 3])
         view top = flat.view(from = TOP)
         view all = flat.view(from = TOP, hidden = DASHED)
         view turned = flat.rotate(x = 90deg).view(from = FRONT)
         view under_a_box = [flat, box(from = [0, 0, 5], to = [4, 2, 6])].view(from = TOP)
         tube = grid(for a in 0..<4 { for z in [0, 5] { [3 * cos(a * 90deg), 3 * sin(a * 90deg), z] } }, closed_u = true)
         view rim = tube.view(from = TOP)",
    );
    // Three lines of 6 and four of 4.
    let grid = 3.0 * 6.0 + 4.0 * 4.0;
    agree(found[0], [grid, 0.0]);
    agree(found[1], [grid, 0.0]);
    agree(found[2], [grid, 0.0]);
    // The box covers one row of cells; its outline lies on their lines on three sides and on the fourth.
    agree(found[3], [grid - 2.0, 2.0]);
    agree(found[4], [4.0 * 18f64.sqrt(), 0.0]);
}

#[test]
fn figures_on_faces_move_and_end_with_them() {
    let found = lengths(
        "cube = box(10, 10, 10)
         line = polyline([[-3, 0], [3, 0]])
         view top = cube.draw_on(TOP, line).view(from = TOP)
         view behind = cube.draw_on(BACK, line).move(z = 3).view(from = FRONT)
         view turned = cube.draw_on(FRONT, line).rotate(z = 90deg).view(from = RIGHT)
         view over_the_border = cube.draw_on(TOP, polyline([[0, 0], [30, 0]])).view(from = TOP)
         view over_a_hole = (cube.draw_on(TOP, line) - box(2, 2, 30).move(z = -5)).view(from = TOP)
         view round = cube.draw_on({ at = [0, 0, 10], normal = TOP }, circle(2)).view(from = TOP)
         view named = (cube + box(6, 6, 4).move(z = 10).tag(\"lid\")).draw_on(\"lid\", line).view(from = TOP)
         view filled = cube.draw_on(TOP, hatch(rect(6, 6), pitch = 2, angle = 0deg)).view(from = TOP)",
    );
    let known = [
        [40.0 + 6.0, 0.0],
        [40.0, 6.0],
        [40.0 + 6.0, 0.0],
        [40.0 + 5.0, 0.0],
        [40.0 + 8.0 + 4.0, 0.0],
        [40.0 + 4.0 * std::f64::consts::PI, 0.0],
        [40.0 + 24.0 + 6.0, 0.0],
    ];
    for (found, known) in found.iter().zip(known) {
        agree(*found, known);
    }
    // Lines at -2, 0 and 2; one on the border counts on one side only.
    assert!(near(found[7][0], 40.0 + 18.0, 1e-6), "{:?}", found[7]);
}

#[test]
fn figures_are_laid_on_round_faces() {
    let found = lengths(
        "can = cylinder(10, 20)
         view bare = can.view(from = FRONT)
         around = can.draw_on({ at = [0, -10, 10] }, polyline([[-3, 0], [3, 0]]))
         view seen = around.view(from = FRONT)
         view behind = around.view(from = BACK)
         view upright = can.draw_on({ at = [0, -10, 10] }, polyline([[1, -3], [1, 30]])).move(x = 5).view(from = FRONT)
         ball = sphere(10)
         view pole = ball.view(from = TOP)
         view ring = ball.draw_on({ at = [0, 0, 10] }, circle(5)).view(from = TOP)",
    );
    let close = |found: f64, known: f64| assert!((found - known).abs() < 0.05, "{found} {known}");
    let bare = found[0][0];
    // An arc of 6 seen from the front.
    close(found[1][0] - bare, 20.0 * libm::sin(0.3));
    close(found[2][0], bare);
    close(found[2][1] - found[0][1], 20.0 * libm::sin(0.3));
    // From 7 to the rim at 20.
    close(found[3][0] - bare, 13.0);
    // Lengths from the pole are kept on the sphere; the circle is a polygon within the tolerance.
    let ring = std::f64::consts::TAU * 10.0 * libm::sin(0.5);
    assert!(near(found[5][0] - found[4][0], ring, 4e-3), "{:?} {ring}", found[5]);
}

#[test]
fn free_arcs_have_the_length_of_their_curve() {
    let quarter = 20.0 * std::f64::consts::FRAC_PI_2;
    let found = lengths(
        "view flat = arc([0, 0, 0], 20, 0deg, 90deg).view(from = TOP)
         view upright = arc([0, 0, 0], 20, 0deg, 90deg).rotate(x = 90deg).view(from = FRONT)
         view half_hidden = [arc([0, 0, 0], 20, 0deg, 360deg), box(60, 60, 60).move(y = -30, z = -30)].view(from = TOP)
         view edge_on = arc([0, 0, 0], 20, 0deg, 180deg).view(from = FRONT)
         view outline = rect(20, 10).round(2).view(from = TOP)",
    );
    agree(found[0], [quarter, 0.0]);
    agree(found[1], [quarter, 0.0]);
    agree(found[2], [240.0 + 2.0 * quarter, 2.0 * quarter]);
    agree(found[3], [40.0, 0.0]);
    agree(found[4], [2.0 * (16.0 + 6.0) + 4.0 * std::f64::consts::PI, 0.0]);
}
