//! What expressions evaluate to.

use super::host::holds;

#[test]
fn the_tour_of_the_language() {
    holds(
        r#"
w = 40mm
deep = 1.5in + 2
assert near(deep, 40.1mm)
tilt = 30deg
face = 100mm^2
p = [10, 20, 5] + [0, 0, 1mm]
assert p.x == 10 and p.z == 6mm and p[-1] == 6mm
bolt = { d = 5mm, head = 8mm }
assert { ..bolt, head = 9mm } == { head = 9mm, d = 5mm }
sizes = 3mm..6mm step 1mm
assert sizes == [3mm, 4mm, 5mm, 6mm] and len(0..<4) == 4
label = "M{bolt.d / 1mm}"
assert label == "M5"
plate = box(w, 30, 5)
slab = box(from = [0, 0, 0], to = [40, 30, 5])
hole = cylinder(d = bolt.d, h = 20)
rod = (rect(20, 10).round(2) - circle(r = 3)).extrude(40, twist = 15deg)
hexa = prism(6, r = 10, h = 4)
ring = rect(3, 8).move(x = 20).revolve(270deg)
post = cylinder(d = 8, h = 25).move(x = 10).rotate(z = 45deg).tag("post")
body = plate
     + post
     - for x in [-15, 15] { hole.move(x = x) }
part clip = body
fn rib(length, t = 2mm, h = 6mm) = box(length, t, h)
fn pattern(shape, n, r) = for i in 0..<n { shape.move(x = r).rotate(z = i * 360deg / n) }
twice = x => 2 * x
assert twice(4mm) == 8mm
star = rib(12).pattern(5, 9)
part stars = star
h2 = if w > 50 { 8mm } else { 6mm }
assert h2 == 6mm
lid = do {
    inset = 0.2mm
    box(w - inset, 30 - inset, 2)
}
part cover = lid
/// Overall width
param width = 60mm in 20mm..120mm step 1mm
param style = "lip" in ["lip", "flat"]
param gap = 0.2mm in 0.05mm..0.6mm when style == "lip"
export "clip.3mf" = clip
export "both-{style}.3mf" = { clip, cover }
assert gap < 0.5mm, "gap {gap} is too loose"
test "a loose lid is refused" fails "gap 0.55mm is too loose" { self(gap = 0.55mm).clip }
test "the box weighs what it should" { assert volume(box(1, 2, 3)) == 6mm^3 }
"#,
    );
}
