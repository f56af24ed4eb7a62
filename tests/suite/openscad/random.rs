//! Random models, each from one number, as Katachi source: what fails is a file to be kept.

use crate::laws::Random;

/// How a model is made.
struct Style {
    /// Whole coordinates, so that faces touch and are coplanar.
    coarse: bool,
    /// Parts turned by odd angles.
    turned: bool,
}

/// A model with at most nine primitives: half of them on a coarse grid, a third turned.
pub fn model(seed: u64) -> String {
    let style = Style { coarse: seed.is_multiple_of(2), turned: seed.is_multiple_of(3) };
    // Neighbouring seeds of the generator are as good as distant ones.
    shape(&mut Random(seed), &style, 2)
}

fn shape(random: &mut Random, style: &Style, levels: u32) -> String {
    if levels == 0 || (levels == 1 && random.below(4) == 0) {
        let leaf = leaf(random, style);
        return placed(random, style, &leaf);
    }
    let count = 2 + random.below(2);
    let parts: Vec<String> = (0..count).map(|_| shape(random, style, levels - 1)).collect();
    let operator = [" + ", " + ", " + ", " - ", " - ", " & "][random.below(6) as usize];
    let whole = format!("({})", parts.join(operator));
    if random.below(3) == 0 { placed(random, style, &whole) } else { whole }
}

/// A shape moved, and perhaps turned.
fn placed(random: &mut Random, style: &Style, shape: &str) -> String {
    let mut coordinate = || number(random, style, 0, 3);
    let [x, y, z] = [coordinate(), coordinate(), coordinate()];
    let moved = format!("{shape}.move(x = {x}, y = {y}, z = {z})");
    let turn = match (style.turned && random.below(2) == 0, style.coarse) {
        (true, _) => ODD_TURNS[random.below(4) as usize],
        (false, true) => QUARTER_TURNS[random.below(4) as usize],
        (false, false) => "",
    };
    moved + turn
}

const ODD_TURNS: [&str; 4] = [
    ".rotate(x = 17, y = 23, z = 41)",
    ".rotate(z = 7)",
    ".rotate([1, 2, 3], 33deg)",
    ".rotate(x = 33, y = 61, z = 5)",
];

const QUARTER_TURNS: [&str; 4] = ["", "", ".rotate(x = 90)", ".rotate(z = 90)"];

/// A number from `low` to `high`: whole on the coarse grid, else of three digits.
fn number(random: &mut Random, style: &Style, low: u64, high: u64) -> String {
    if style.coarse {
        return (low + random.below(high - low + 1)).to_string();
    }
    format!("{:.3}", low as f64 + random.unit() * (high - low) as f64)
}

fn leaf(random: &mut Random, style: &Style) -> String {
    let kind = random.below(8);
    let mut size = |low, high| number(random, style, low, high);
    match kind {
        0..=2 => {
            format!("box(from = [0, 0, 0], to = [{}, {}, {}])", size(1, 4), size(1, 4), size(1, 4))
        }
        3 => {
            let (x, y) = (size(1, 4), size(1, 4));
            let outline = format!("[[0, 0], [{x}, 0], [{x}, {y}], [0, {}]]", size(4, 6));
            format!("prism(polygon({outline}), h = {})", size(1, 4))
        }
        4 => format!("prism({}, r = {}, h = {})", 3 + random.below(4), 1 + random.below(2), 2),
        5 => {
            let (r, h) = (size(1, 3), size(1, 4));
            format!("cylinder(r = {r}, h = {h}, sides = {})", 4 + random.below(9))
        }
        6 => {
            let (r1, r2, h) = (size(1, 3), size(0, 2), size(1, 4));
            format!("cone(r1 = {r1}, r2 = {r2}, h = {h}, sides = {})", 4 + random.below(5))
        }
        _ => format!("sphere(r = {}, sides = {})", size(1, 3), 4 + random.below(7)),
    }
}
