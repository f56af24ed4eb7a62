//! What expressions evaluate to.

use super::host::holds;

#[test]
fn the_tour_of_the_language() {
    holds(
        r#"
w = 40mm
deep = 1.5in + 2
assert deep == 40.1mm
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

#[test]
fn numbers_carry_dimensions() {
    holds(
        r#"
assert 2mm * 3mm == 6mm^2 and 6mm^2 / 2mm == 3mm and (10mm)^2 == 100mm^2
assert 10mm / 4mm == 2.5 and 1 / 4mm == 0.25mm^-1
assert 1in == 25.4mm and 1ft == 304.8mm and 1cm == 10mm and 1m == 1000mm and 1um == 0.001mm
assert 1turn == 360deg and near(1rad, 57.29577951308232deg) and 1cm^2 == 100mm^2
assert 5 == 5mm and 5mm + 1 == 6mm and 90 == 90deg and 2 < 3mm
assert [1, [2, 3]] == [1mm, [2mm, 3mm]] and { a = 1 } == { a = 1mm }
assert min(1, 2mm) == 1mm and max([1mm, 5, 3]) == 5mm and clamp(7, 0mm, 5mm) == 5mm
assert near(1mm, 1.0000000001) and near([1, 2], [1mm, 2mm]) and not near(1, 2)
assert -2^2 == -4 and 2^-1 == 0.5 and 2^0.5 == sqrt(2) and sqrt(4mm^2) == 2mm
assert 7 % 3 == 1 and -7 % 3 == -1 and mod(-7, 3) == 2 and 7mm % 3 == 1mm
assert 1 != "1" and NONE == NONE and NONE != 0 and "a" < "b" and true != 1
assert norm([3mm, 4mm]) == 5mm and dot([1mm, 2mm, 3mm], [1, 0, 2]) == 7mm
assert cross([1, 0, 0], [0, 1, 0]) == [0, 0, 1]
assert 2 * [1, 2] == [2, 4] and [2, 4] / 2 == [1, 2] and -[1, 2] == [-1, -2] and [[1], [2]] * 2 == [[2], [4]]
"#,
    );
}

#[test]
fn trigonometry_is_exact_where_it_is_rational() {
    holds(
        r#"
assert sin(30deg) == 0.5 and sin(150) == 0.5 and sin(210) == -0.5 and sin(330deg) == -0.5
assert cos(60deg) == 0.5 and cos(120) == -0.5 and tan(45deg) == 1 and tan(135deg) == -1
assert sin(0) == 0 and sin(90) == 1 and sin(180) == 0 and sin(270) == -1 and sin(360) == 0
assert cos(0) == 1 and cos(90) == 0 and cos(180) == -1 and cos(270) == 0 and cos(-90) == 0
assert asin(1) == 90deg and acos(0) == 90deg and atan(1) == 45deg and atan2(1, 0) == 90deg
assert atan2(-1mm, 0mm) == -90deg
for i in 0..<8 { assert_near(sin(i * 45deg)^2 + cos(i * 45deg)^2) }
fn assert_near(x) {
    assert near(x, 1), "{x}"
    EMPTY
}
"#,
    );
}

#[test]
fn values_print_as_they_are_written() {
    holds(
        r#"
assert "{40mm} {30deg} {100mm^2} {0.1} {1 / 4mm}" == "40mm 30deg 100mm^2 0.1 0.25mm^-1"
assert "{[1, 2mm, "a"]} {{x}} {true}" == "[1, 2mm, \"a\"] {{x}} true"
assert "{{ a = 1 }}" == "{{ a = 1 }}"
r = { d = 5mm, name = "M5" }
assert "{r}" == "{{ d = 5mm, name = \"M5\" }}"
assert "{1..3} {1mm..<3mm step 0.5}" == "1..3 1mm..<3mm step 0.5mm"
assert "{1e20} {1 / 3} {100000000} {1e-9}" == "1e20 0.3333333333333333 100000000 1e-9"
assert "{box(1, 1, 1)} {LEFT} {NONE} {sin} {x => x}" == "<solid> LEFT NONE <function sin> <function>"
assert "a" ++ "b" == "ab" and [1] ++ [2, 3] == [1, 2, 3] and (0..1) ++ [5] == [0, 1, 5]
"#,
    );
}

#[test]
fn ranges_are_lists() {
    holds(
        r#"
assert len(0..<5) == 5 and (0..4)[-1] == 4 and len(5..0) == 0 and 5..0 step -2 == [5, 3, 1]
assert len(0..1 step 0.1) == 11 and (0..1 step 0.1)[3] == 0 + 3 * 0.1
assert 1in..3in == [1in, 2in, 3in] and 1..3mm == [1mm, 2mm, 3mm]
assert len(0..1e12) == 1e12 + 1 and (0..1e12)[-1] == 1e12
assert (for i in 0..2, j in 0..<i { [i, j] }) == [[1, 0], [2, 0], [2, 1]]
assert (for c, i in ["a", "b"] { "{c}{i}" }) == ["a0", "b1"]
assert (for i in 0..9 if i % 4 == 0 { i }) == [0, 4, 8]
assert (for c in "形a" { c }) == ["形", "a"] and "形a"[0] == "形" and len("形a") == 2
assert sum(0..100) == 5050 and reverse(1..3) == [3, 2, 1]
"#,
    );
}

#[test]
fn functions_close_over_what_they_see() {
    holds(
        r#"
fn adder(n) = x => x + n
assert adder(2)(3) == 5 and map([1, 2], adder(10)) == [11, 12]
fn outer(n) {
    fn fact(k) = if k < 2 { 1 } else { k * fact(k - 1) }
    twice = x => 2 * fact(x) + n
    twice(4)
}
assert outer(1) == 49
fn compose(f, g) = x => f(g(x))
assert compose(sqrt, x => x * x)(3mm) == 3mm
fn plate(w, d = w / 2, h: Length = 3) = [w, d, h]
assert plate(8) == [8, 4, 3mm] and plate(8, h = 1) == [8, 4, 1] and 8.plate(d = 1)[1] == 1
args = { d = 1, h = 2 }
assert plate(..[7], ..args) == [7, 1, 2]
shapes = { make = (a, b) => box(a, b, 1), n = 3 }
part p = shapes.make(1, 2)
assert (0..3).map((x, i) => x * i) == [0, 1, 4, 9]
assert [[3, "c"], [1, "a"], [1, "b"]].sort(key = p => p[0]).map(p => p[1]) == ["a", "b", "c"]
fn typed(a: Length, b: List[Angle], c: Optional[Count] = NONE) -> Length = if c == NONE { a } else { a * c }
assert typed(2, [30, 1turn]) == 2mm and typed(2, [], c = 3) == 6mm
"#,
    );
}

#[test]
fn what_the_language_leaves_to_custom() {
    holds(
        r#"
assert (9mm^2)^0.5 == 3mm and (8mm^3)^(1 / 3) == 2mm and 7cm == 0.07m
assert (0..0.3 step 0.1)[-1] == 0.3
assert max(1, 2mm, 3, 4, 5) == 5mm and min(6, 5, 4, 3, 2, 1) == 1
assert all([true, true]) and not all([true, false]) and any([false, true]) and not any([])
fn density(d) = mass(box(10, 10, 10), d)
assert near(density(0.00124), 1.24) and near(density(1.24 / 1cm^3), 1.24)
"#,
    );
}
