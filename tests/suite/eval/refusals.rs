//! Bad input: what is said, and where.

use katachi::eval::Limits;

use super::host::{holds, refuses, run_files, run_limited, say};

#[test]
fn an_unknown_parameter() {
    refuses(
        "part p = cylinder(radius = 5, h = 2)",
        &[
            "unknown-argument: `cylinder` has no parameter `radius` @radius@",
            "did you mean `r`?",
            "signature: cylinder(r: Length, h: Length, sides: Count =)",
        ],
    );
}

#[test]
fn a_missing_argument() {
    refuses(
        "part p = box(40, 30)",
        &["missing-argument: missing `z` in the call of `box` @40@", "label given\n  label given"],
    );
    refuses("part p = box()", &["missing `x`", "nothing is given"]);
}

#[test]
fn a_fraction_of_an_inch() {
    refuses(
        "part p = box(1/4in, 2, 3)",
        &[
            "dimension: `x` of `box` needs a length, got",
            "(1/length) @1/4in@",
            "did you mean `0.25in`?",
        ],
    );
    refuses("a = 1/4in + 2mm", &["1/length and a length", "did you mean `0.25in`?"]);
    refuses("a: Length = 1/4in", &["did you mean `0.25in`?"]);
}

#[test]
fn dimensions_that_differ() {
    refuses(
        "a = 2mm + 30deg",
        &[
            "dimension: dimensions differ in `+`: a length and an angle @2mm@",
            "label a length",
            "label an angle",
        ],
    );
    refuses(
        "a = sin(10mm)",
        &["dimension: `a` of `sin` needs an angle, got `10mm` (a length) @10mm@"],
    );
    refuses("a = 2mm == 30deg", &["dimensions differ in `==`"]);
    refuses("a = [2mm] == [30deg]", &["dimensions differ in `==`"]);
    refuses("a = 2mm^2 < 3", &["an area and a bare number"]);
    refuses("a = max(2mm, 30deg)", &["dimension:"]);
    refuses("a = near(2mm, 3mm^2)", &["dimension:"]);
    refuses("a = (2mm)^0.5", &["a length to the power 0.5 has no dimension", "are whole numbers"]);
    refuses("a = sqrt(2mm)", &["a length has no square root"]);
    refuses("a = 2^1mm", &["an exponent needs a bare number"]);
    refuses("a = (1mm)^200", &["the exponent of a dimension is too large"]);
}

#[test]
fn second_definitions() {
    refuses(
        "x = 1\nx = 2",
        &[
            "duplicate: `x` is already defined @x@",
            "label defined again here",
            "label first defined here",
        ],
    );
    refuses("fn f(a, a) = a", &["`a` is already defined"]);
    refuses("a = do {\n b = 1\n b = 2\n b\n}", &["`b` is already defined"]);
    refuses("a = { b = 1, b = 2 }", &["`b` is already defined"]);
    refuses("param x = 1\npart x = box(1, 1, 1)", &["`x` is already defined"]);
    holds("x = 1\na = do {\n x = 2\n x + 1\n}\nassert a == 3 and x == 1");
    holds("fn box(a) = a + 1\nassert box(2) == 3");
}

#[test]
fn unknown_names() {
    refuses(
        "a = cylnder(1, 2)",
        &["unknown-name: unknown name `cylnder` @cylnder@", "did you mean `cylinder`?"],
    );
    refuses("a = box(1, 1, 1).translate([1, 2, 3])", &["here this is `move`"]);
    refuses("width = 3\na = widht + 1", &["did you mean `width`?"]);
    refuses("a = box(1, 2, 3).filet(2)", &["unknown name `filet` @filet@"]);
    refuses(
        "view v = box(1, 2, 3).view(from = 1)",
        &["a view is from a side or a direction", "@1@"],
    );
    refuses("a = metabal([1])", &["unknown name `metabal`", "metaball"]);
    refuses("a = builtin(\"math.sin\")", &["unknown name `builtin`"]);
    refuses("fn f(x: Lenght) = x", &["there is no type `Lenght`", "did you mean `Length`?"]);
    refuses("set kernel = TET", &["unknown-name: there is no kernel `TET` @TET@", "`EXACT`"]);
    refuses("set kernel = NONE", &["there is no kernel `NONE`", "the kernels are `EXACT`"]);
    refuses("set tolerence = 1", &["there is no setting `tolerence`"]);
}

#[test]
fn elements_that_are_not_there() {
    refuses(
        "a = [1, 2, 3]\nb = a[3]",
        &["out-of-range: index 3 is out of range @3@", "it has 3 elements: 0 to 2, or -3 to -1"],
    );
    refuses("a = [1, 2, 3]\nb = a[-4]", &["index -4 is out of range"]);
    refuses("a = [1, 2, 3]\nb = a[0.5]", &["an index is a whole bare number, got `0.5`"]);
    refuses(
        "a = { width = 1 }\nb = a.widht",
        &["missing-key: the record has no `widht` @widht@", "did you mean `width`?"],
    );
    refuses("a = { w = 1 }\nb = a.q", &["it has `w`"]);
    refuses(
        "a = prism(2.5, 3, 4)",
        &["out-of-range: `n` of `prism` needs a whole number, 0 or more, got `2.5`"],
    );
    refuses("a = [1, 2].z", &["a list has no `z`"]);
}

#[test]
fn degenerate_sizes() {
    for (source, word) in [
        ("box(0, 1, 1)", "`x` must be greater than 0, got 0mm @0@"),
        ("sphere(-1)", "`r` must be greater than 0, got -1mm"),
        ("cylinder(r = 1, h = -2)", "`h` must be greater than 0"),
        ("cone(0, 0, 1)", "when the other end is 0"),
        ("box(from = [0, 0, 0], to = [1, 0, 1])", "no extent along y"),
        ("torus(5, 6)", "must be below `R`"),
        ("rect(1, 0)", "`y` must be greater than 0"),
        ("rect(1, 1).extrude(0)", "`h` must be greater than 0"),
        ("rect(1, 1).revolve(0deg)", "`angle` must be above 0deg"),
        ("polygon([[0, 0], [1, 0]])", "at least 3 different points"),
        ("polygon([[0, 0], [1, 0], [2, 0]])", "lie on one line"),
        ("box(1, 1, 1).scale(0)", "`k` must not be 0"),
        ("box(1, 1, 1).scale(y = 0)", "`y` must not be 0"),
        ("box(1, 1, 1).mirror([0, 0, 0])", "zero vector"),
        ("box(1, 1, 1).rotate([0, 0, 0], 3deg)", "zero vector"),
        ("box(1, 1, 1).transform([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]])", "flattens space"),
        ("hull([])", "holds no shape"),
    ] {
        refuses(&format!("a = {source}"), &["degenerate: ", word]);
    }
    refuses("a = circle(1, sides = 2)", &["`sides` must be at least 3, got 2"]);
}

#[test]
fn arithmetic_that_has_no_result() {
    refuses("a = 1 / 0", &["arithmetic: division by zero @0@"]);
    refuses("a = 1mm % 0mm", &["division by zero"]);
    refuses("a = sqrt(-1)", &["square root of a negative number"]);
    refuses("a = 1e200 * 1e200", &["too large for a number"]);
    refuses("a = exp(1000)", &["too large for a number"]);
    refuses("a = ln(0)", &["a logarithm needs a number above 0"]);
    refuses("a = asin(2)", &["from -1 to 1"]);
    refuses("a = tan(90deg)", &["the tangent of 90deg is infinite"]);
    refuses("a = (-8)^(1/3)", &["no power with a fraction"]);
    refuses("a = 0^-1", &["0 to a negative power"]);
    refuses("a = 1e999", &["too large"]);
}

#[test]
fn kinds_that_do_not_fit() {
    refuses(
        "a = box(\"a\", 1, 1)",
        &[
            "wrong-kind: `x` of `box` needs a length, got the string \"a\"",
            "signature: box(x: Length",
        ],
    );
    refuses("a = volume(rect(1, 1))", &["`s` of `volume` needs a solid, got a profile"]);
    refuses(
        "a = box(1, 1, 1) + rect(1, 1)",
        &["`+` cannot mix solids and profiles", "label a solid", "label a profile"],
    );
    refuses("a = \"a\" + 1", &["`+` cannot take a string and a bare number", "`++` joins strings"]);
    refuses("a = 1\nb = a(2)", &["a bare number cannot be called"]);
    refuses("a = if 1 { 2 } else { 3 }", &["needs a truth value, got `1`"]);
    refuses("a = [1, 2] + [1, 2, 3]", &["lists of 2 and 3 elements"]);
    refuses("part p = rect(1, 1)", &["the part `p` needs a solid, got a profile", ".extrude(h)"]);
    refuses("part p = 5", &["the part `p` needs a solid, got `5`"]);
    refuses("fn f(a: Length) -> Angle = a\nb = f(1)", &["needs an angle, got `1mm`"]);
    refuses(
        "fn f(a, b = 2) = a + b\nc = f(1, 2)",
        &["`f` takes one positional argument, got 2", "`b = 2`"],
    );
    refuses("a = for i in 5 { i }", &["`for` runs over a list or range"]);
    refuses("a = 1..5 step 0", &["the step of a range cannot be 0"]);
    refuses("a = 1mm..5deg", &["dimensions differ in the bounds of a range"]);
    refuses("a = box(1, 1, 1).color(\"blu\")", &["there is no colour \"blu\"", "`blue`"]);
    refuses("a = golden(\"a.stl\", box(1, 1, 1))", &["in tests only"]);
}

#[test]
fn cycles_show_their_path() {
    refuses(
        "a = b + 1\nb = c\nc = a",
        &["cycle: these definitions need each other: `a` -> `b` -> `c` -> `a`"],
    );
    refuses(
        "a = f(1)\nfn f(x) = x + a",
        &["`a` -> `f`"].map(|_| "cycle: these definitions need each other: `a` -> `a`"),
    );
    refuses("pub x = self().x", &["cycle"]);
}

#[test]
fn endless_recursion_shows_its_cycle() {
    refuses(
        "fn even(n) = odd(n - 1)\nfn odd(n) = even(n - 1)\na = even(5)",
        &["endless-recursion: endless recursion: `", "`odd` -> `even`", "is called here"],
    );
    refuses("fn f(n) = f(n) + 1\na = f(5)", &["endless recursion: `f` -> `f`"]);
    refuses("param n = 1\npub a = self(n = n + 1).a", &["endless"]);
}

#[test]
fn deep_recursion_that_ends_is_fine() {
    holds("fn f(n) = if n == 0 { 0 } else { 1 + f(n - 1) }\nassert f(10000) == 10000");
    let chain: String = (1..5000).map(|i| format!("x{i} = x{} + 1\n", i - 1)).collect();
    holds(&format!("{chain}x0 = 0\nassert x4999 == 4999"));
    // Dropped without recursion.
    holds("a = fold(0..<200000, [], (deep, i) => [deep])\nassert len(a) == 1");
    holds("a = fold(0..<50000, x => x, (f, i) => (x => f(x)))\nb = 1\nassert b == 1");
}

#[test]
fn limits_are_counted() {
    let limits = Limits { steps: 1_000_000, values: 1_000_000, depth: 1000 };
    for source in [
        "a = sum(for i in 0..1e12 { 1 })",
        "a = for i in 0..1e12 { 1 }",
        "a = sum(0..1e12)",
        "a = len(map(0..1e12, x => x))",
        "a = fold(0..<100, \"ab\", (s, i) => s ++ s)",
        "a = fold(0..<100, [1, 2], (s, i) => s ++ s)",
        "a = fold(0..<100, \"ab\", (s, i) => \"{s}{s}\")",
        "a = for i in 0..<2000, j in 0..<2000 { i * j }",
        "a = reverse(0..1e12)",
        "a = zip(0..1e12, 0..1e12)",
        "a = (0..1e12) * 2",
        "a = sort(0..1e12)",
        "d = fold(0..<60, 1, (a, i) => [a, a])\ne = fold(0..<60, 1, (a, i) => [a, a])\na = d == e",
        "d = fold(0..<60, 1, (a, i) => [a, a])\ne = fold(0..<60, 1, (a, i) => [a, a])\na = near(d, e)",
        "d = fold(0..<60, 1, (a, i) => [a, a])\na = -d",
        "d = fold(0..<60, 1, (a, i) => [a, a])\na = d * 2",
        "d = fold(0..<60, 1, (a, i) => [a, a])\na = flatten(d)",
        "d = fold(0..<60, 1, (a, i) => [a, a])\ne = fold(0..<60, 1, (a, i) => [a, a])\na = sort([d, e])",
        "a = fold(0..<100000, EMPTY, (s, i) => s + box(i + 1, 1, 1))",
        "a = (0..1e12) ++ [1]",
        "a = box(1, 1, 1).row(100000000000, step = 1)",
    ] {
        let words = run_limited(&[("main.kata", source)], &[], limits).words();
        let count = source.contains("100000000000");
        assert!(words.contains("limit: ") || count, "{source}\n{words}");
    }
}

#[test]
fn lists_that_hold_themselves_many_times_over() {
    holds(
        "d = fold(0..<60, 1, (a, i) => [a, a])\nassert len(\"{d}\") < 20000 and d == d\n\
         s = fold(0..<60, box(1, 1, 1), (a, i) => [a, a])\npart p = s.move(x = 1) + s",
    );
}

#[test]
fn long_sums_of_shapes_take_little_memory() {
    holds("part p = fold(0..<20000, EMPTY, (s, i) => s + box(i + 1, 1, 1))");
    holds("part p = fold(0..<20000, box(1, 1, 1), (s, i) => s - box(i + 2, 1, 1))");
}

#[test]
fn operators_side_by_side_have_no_limit_but_that_of_steps() {
    let chain = |term: &str, last: &str| term.repeat(100_000) + last;
    holds(&format!("assert {} == 100001", chain("1 + ", "1")));
    holds(&format!("assert {} == 2", chain("2 / 4 * 2 * ", "2")));
    holds(&format!("a = true\nassert {}", chain("a and ", "a")));
    holds(&format!("a = false\nassert {}", chain("a or ", "true")));
    holds(&format!("b = [1]\nassert len({}) == 1001", "b ++ ".repeat(1000) + "b"));
    holds(&format!("b = box(1, 1, 1)\npart p = {}", chain("b + ", "b")));
    refuses(
        &format!("a = {}", chain("1 + ", "2deg + 1mm")),
        &["dimensions differ in `+`: an angle and a length"],
    );
}

#[test]
fn elements_given_as_a_list_are_told_to_go_without_brackets() {
    refuses(
        "a = box([1, 2, 3])",
        &[
            "`x` of `box` needs a length, got the list [1, 2, 3]",
            "without the brackets: `box(1, 2, 3)`",
        ],
    );
    refuses("a = cylinder([5mm], h = 2)", &["without the brackets: `cylinder(5mm)`"]);
    refuses("a = box([1, 2])", &["missing `to` in the call of `box`"]);
}

#[test]
fn sizes_beyond_reach_name_the_range() {
    refuses(
        "a = box(1e300, 1, 1)",
        &[
            "out-of-range: `x` holds 1e300mm; lengths and coordinates lie between -1e12mm and 1e12mm",
        ],
    );
    refuses("a = polygon([[0, 0], [-1e300, 0], [0, 1]])", &["`points` holds -1e300mm"]);
    refuses("a = box(1, 1, 1).scale(1e9).scale(1e9)", &["its map holds numbers beyond 1e12"]);
    refuses("a = sphere(1, sides = 1e11)", &["limit: `sides` is at most 100000, got 100000000000"]);
    refuses(
        "a = sphere(1, sides = 1e30)",
        &["`sides` of `sphere` is at most 9007199254740992, got 1e30"],
    );
}

#[test]
fn a_file_sets_the_seed_of_its_noise() {
    holds(
        "set seed = 3\nassert noise(0.3) == noise(0.3, seed = 3) and noise(0.3) != noise(0.3, seed = 0)",
    );
    holds("assert noise(0.3) == noise(0.3, seed = 0)");
    holds("set seed = n + 1\nn = 2\nassert map([0.3], noise) == [noise(0.3, seed = 3)]");
    refuses(
        "set seed = floor(noise(0.5))\na = noise(0.5)",
        &["the seed of this file needs itself"],
    );
    refuses("set seed = 0.5", &["needs a whole number, 0 or more, got `0.5`"]);
}

#[test]
fn parameters_are_checked() {
    let source = "param width: Length = 60mm in 20mm..120mm step 1mm\nparam style = \"lip\" in [\"lip\", \"flat\"]\npart p = box(width, 1, 1)";
    let with =
        |name: &str, value: &str| run_files(&[("main.kata", source)], &[(name, value)]).words();
    assert_eq!(with("width", "40mm"), "");
    assert_eq!(with("width", "40"), "");
    assert_eq!(with("style", "\"flat\""), "");
    for (name, value, needed) in [
        (
            "width",
            "10mm",
            "bad-param: the parameter `width` is 10mm; it must be in 20mm..120mm step 1mm",
        ),
        ("width", "60.5mm", "the nearest values are 60mm and 61mm"),
        (
            "width",
            "30deg",
            "dimension: the parameter `width` needs a length, got `30deg` (an angle) @30deg@",
        ),
        ("widht", "30", "main.kata has no parameter `widht`"),
        ("widht", "30", "did you mean `width`?"),
        ("q", "30", "its parameters are `width`, `style`"),
        ("style", "\"lop\"", "it must be in [\"lip\", \"flat\"]"),
        ("style", "3", "the parameter `style` is \"3\"; it must be in"),
        ("width", "3 +", "nothing follows `+`"),
        ("width", "zz", "unknown name `zz`"),
    ] {
        let words = with(name, value);
        assert!(words.contains(needed), "{name} = {value}: {words}");
    }
}

#[test]
fn asserts_show_their_values() {
    refuses(
        "param gap = 0.55mm\nassert gap < 0.5mm, \"gap {gap} is too loose\"",
        &["assertion-failed: gap 0.55mm is too loose @gap < 0.5mm@", "gap = 0.55mm"],
    );
    refuses("a = [1, 2]\nassert len(a) == 3", &["this does not hold: `len(a) == 3`", "len(a) = 2"]);
    refuses("a = 1.5\nassert near(a, 2, tol = 0.1)", &["a = 1.5"]);
    refuses("assert 1 == 2\nassert 3 == 4", &["`1 == 2`", "`3 == 4`"]);
}

#[test]
fn one_failure_leaves_the_rest() {
    let words = say("part a = box(0, 1, 1)\npart b = box(1, 1, 1)\npart c = sphere(-1)\nd = q");
    assert_eq!(words.matches("degenerate:").count(), 2, "{words}");
    assert_eq!(words.matches("unknown name `q`").count(), 1, "{words}");
    let twice = say("r = 1 / 0\npart a = sphere(r)\npart b = sphere(r + 1)");
    assert_eq!(twice.matches("division").count(), 1, "{twice}");
}

#[test]
fn unused_values_are_warned_of() {
    refuses(
        "1 + 2\npart p = box(1, 1, 1)",
        &["unused: this value is not used: `3` (a bare number) @1 + 2@"],
    );
    refuses("a = do {\n 5\n box(1, 1, 1)\n}", &["unused: this value is not used @5@"]);
    refuses("a = do {\n box(2, 2, 2)\n box(1, 1, 1)\n}", &["join the shapes with `+`"]);
}

#[test]
fn blocks_and_decisions_need_values() {
    refuses("a = do {\n b = 1\n}", &["this block has no value"]);
    refuses("a = if true { 1 }", &["this `if` has no `else`"]);
    holds("a = for i in 0..5 { if i % 2 == 0 { i } }\nassert a == [0, 2, 4]");
    holds(
        "a = for i in 0..5 {\n b = i * 2\n if b > 4 { b } else if b == 2 { 0 }\n}\nassert a == [0, 6, 8, 10]",
    );
}

#[test]
fn files_that_use_files() {
    let hinge = "param pin = 2mm in 1mm..5mm\npub gap = pin / 10\nhidden = 3\npart leaf = box(pin, pin, pin)\npub fn twice(x) = 2 * x\nassert pin != 4mm, \"four is unlucky\"";
    let files = |main| run_files(&[("main.kata", main), ("parts/hinge.kata", hinge)], &[]).words();
    assert_eq!(
        files(
            "use \"parts/hinge.kata\" as h with { pin = 3mm }\nassert h.gap == 0.3mm and h.pin == 3mm and h.twice(4) == 8\npart p = h.leaf"
        ),
        ""
    );
    assert_eq!(
        files(
            "use \"parts/hinge.kata\"\nuse \"parts/hinge.kata\" { gap as g, twice }\nassert hinge.gap == g and twice(1) == 2"
        ),
        ""
    );
    for (main, needed) in [
        (
            "use \"parts/hinge.kata\" as h\na = h.hidden",
            "private: `hidden` is private to parts/hinge.kata",
        ),
        ("use \"parts/hinge.kata\" { hidden }\na = hidden", "private"),
        ("use \"parts/hinge.kata\" { gup }", "unknown name `gup`"),
        ("use \"parts/hinge.kata\" as h\na = h.gup", "did you mean `gap`?"),
        ("use \"parts/hinge.kata\" as h with { pim = 3 }\na = h.gap", "has no parameter `pim`"),
        ("use \"parts/hinge.kata\" as h with { pin = 30mm }\na = h.gap", "must be in 1mm..5mm"),
        ("use \"parts/hinge.kata\" as h with { pin = 4mm }\na = h.gap", "four is unlucky"),
        ("use \"parts/door.kata\" as h", "unreadable-file: cannot read `parts/door.kata`"),
        ("use \"../door.kata\" as h", "outside-root"),
        ("use \"std/metrik\" as h", "unreadable-file"),
    ] {
        let words = files(main);
        assert!(words.contains(needed), "{main}\n{words}");
    }
    let cycle = run_files(
        &[
            ("main.kata", "use \"a.kata\"\nx = 1"),
            ("a.kata", "use \"b.kata\""),
            ("b.kata", "use \"a.kata\""),
        ],
        &[],
    );
    assert!(
        cycle.words().contains("use-cycle: files use each other: a.kata -> b.kata -> a.kata"),
        "{}",
        cycle.words()
    );
}

#[test]
fn errors_inside_the_library_stand_at_the_call() {
    for (call, words) in [
        ("box(1, 1, 1).grid_of([2, 2, 2], [3, 3])", "`n` has 3 numbers and `step` has 2"),
        ("box(1, 1, 1).grid_of([2], [3, 3])", "a grid needs 2 or 3"),
        ("box(1, 1, 1).attach(box(2, 2, 2), side = NONE)", "a side is LEFT, RIGHT"),
        ("rect(1, 1).revolve(sides = 2)", "`sides` must be at least 3, got 2"),
        ("prism(rect(1, 1), 0)", "`h` must be greater than 0, got 0mm"),
        ("map([1, 2], 5)", "`f` of `map` needs a function, got `5`"),
    ] {
        let marked = if call.starts_with("map") { "@5@".into() } else { format!("@{call}@") };
        refuses(&format!("part p = {call}"), &[words, &marked]);
    }
}
