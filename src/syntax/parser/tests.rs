//! The parser on whole texts.

use super::*;
use crate::syntax::ast::{self, Expr, ExprKind, ItemKind, Piece, StmtKind};

fn words(text: &str) -> Vec<String> {
    let (_, diagnostics) = parse(SourceId(0), text);
    diagnostics
        .iter()
        .map(|d| {
            let span = d.span().unwrap();
            format!("{} `{}`", d.message, &text[span.start as usize..span.end as usize])
        })
        .collect()
}

#[test]
fn the_language_by_example_has_no_error() {
    assert_eq!(words(include_str!("../../../tests/grammar/language.kata")), [""; 0]);
    assert_eq!(words(include_str!("../../../tests/grammar/program.kata")), [""; 0]);
}

fn repeated(before: &str, count: usize, middle: &str, after: &str) -> String {
    before.repeat(count) + middle + &after.repeat(count)
}

/// Texts that nest ten thousand deep, each in another way.
fn deep_texts(count: usize) -> Vec<String> {
    vec![
        repeated("(", count, "1", ")"),
        repeated("(", count, "", ""),
        repeated("[", count, "1", "]"),
        repeated("{a=", count, "1", "}"),
        repeated("do{", count, "1", "}"),
        repeated("-", count, "1", ""),
        repeated("- ", count, "1", ""),
        repeated("not ", count, "1", ""),
        repeated("if a { 1 } else ", count, "{ 2 }", ""),
        repeated("if a { ", count, "1", "}"),
        repeated("for a in b { ", count, "1", "}"),
        repeated("fn f() = do { ", count, "1", "}"),
        repeated("fn f() { ", count, "1", "}"),
        repeated("a => ", count, "1", ""),
        repeated("(a, b) => ", count, "1", ""),
        repeated("2^", count, "1", ""),
        repeated("if 1 + ", count, "1", ""),
        repeated("1 + if a { 2 } else ", count, "{ 3 }", ""),
        repeated("a.b", count, "", ".c"),
        repeated("a", 1, "", "(1)").replace("(1)", &"(1)".repeat(count)),
        repeated("f(", count, "1", ")"),
        repeated("a[", count, "1", "]"),
        repeated("\"{", count, "1", "}\""),
        "x: ".to_string() + &repeated("A[", count, "B", "]") + " = 1",
    ]
}

#[test]
fn nesting_too_deep_is_an_error_not_a_crash() {
    let run = || {
        for text in deep_texts(10_000).into_iter().chain(deep_texts(100_000)) {
            let text = format!("w = 1\nx = {text}\ny = 2\n");
            let (program, diagnostics) = parse(SourceId(0), &text);
            let head: String = text.chars().take(30).collect();
            assert_eq!(diagnostics[0].code, crate::base::Code::TooDeep, "{head}");
            assert_eq!(diagnostics.len(), 1, "{head}");
            assert!(program.items.len() >= 2);
        }
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

#[test]
fn what_stands_side_by_side_is_not_deep() {
    let count = 100_000;
    for term in ["a + ", "a * ", "a and ", "a or ", "f(a)[1].b ++ ", "-a^2 - ", "not a < 2 and "] {
        let text = format!("x = {}a", term.repeat(count));
        let (program, diagnostics) = parse(SourceId(0), &text);
        assert_eq!(diagnostics, [], "{term}");
        assert_eq!(program.clone(), program);
    }
    let mixed = "x = ".to_string() + &"a * b + c & d < e and ".repeat(count) + "f";
    assert_eq!(words(&mixed), [""; 0]);
}

#[test]
fn the_deepest_allowed_tree_fits_a_small_stack() {
    let run = || {
        for count in [200, 1000] {
            for text in deep_texts(count) {
                let (program, diagnostics) = parse(SourceId(0), &text);
                if diagnostics.is_empty() {
                    let copy = program.clone();
                    assert!(copy == program);
                    assert!(format!("{program:?}").len() > count);
                }
            }
        }
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

fn expr_of(text: &str) -> String {
    let (program, diagnostics) = parse(SourceId(0), text);
    assert!(diagnostics.is_empty(), "{text}: {diagnostics:?}");
    let ItemKind::Stmt { stmt, .. } = &program.items[0].kind else { panic!("{text}") };
    match &stmt.kind {
        StmtKind::Expr(expr) => show(expr),
        StmtKind::Bind { value, .. } => show(value),
        other => panic!("{other:?}"),
    }
}

/// Every operation in parentheses.
fn show(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number { value, unit } => {
            let unit = unit.as_ref().map(|u| format!("{:?}^{}", u.name, u.exponent));
            format!("{value}{}", unit.unwrap_or_default())
        }
        ExprKind::Name(name) => name.text.to_string(),
        ExprKind::Paren(inner) => show(inner),
        ExprKind::Unary { op, operand, .. } => format!("({op:?} {})", show(operand)),
        ExprKind::Binary(binary) => {
            format!("({} {:?} {})", show(&binary.left), binary.op, show(&binary.right))
        }
        ExprKind::Chain(chain) => chain.links.iter().fold(show(&chain.first), |left, link| {
            format!("({left} {:?} {})", link.op, show(&link.right))
        }),
        ExprKind::Range(range) => {
            let step = range.step.as_ref().map(|s| format!(" step {}", show(s)));
            let dots = if range.inclusive { ".." } else { "..<" };
            let ends = (show(&range.start), show(&range.end));
            format!("({}{dots}{}{})", ends.0, ends.1, step.unwrap_or_default())
        }
        ExprKind::Member(member) => format!("{}.{}", show(&member.object), member.name.text),
        ExprKind::Call { callee, arguments } => format!("{}({})", show(callee), arguments.len()),
        ExprKind::Lambda { params, body } => format!("({} => {})", params.len(), show(body)),
        other => format!("{other:?}"),
    }
}

#[test]
fn operators_bind_as_the_grammar_says() {
    for (text, tree) in [
        ("1 + 2 * 3", "(1 Add (2 Multiply 3))"),
        ("1 - 2 - 3", "((1 Subtract 2) Subtract 3)"),
        ("a - b & c", "(a Subtract (b Intersect c))"),
        ("-2^2", "(Negate (2 Power 2))"),
        ("2^-1", "(2 Power (Negate 1))"),
        ("2^3^4", "(2 Power (3 Power 4))"),
        ("-a.b(1)", "(Negate a.b(1))"),
        ("not a == b", "(Not (a Equal b))"),
        ("not a and b or c", "(((Not a) And b) Or c)"),
        ("a + 1..b - 1 step 2 * c", "((a Add 1)..(b Subtract 1) step (2 Multiply c))"),
        ("0..<n == m", "((0..<n) Equal m)"),
        ("x => x + 1", "(1 => (x Add 1))"),
        ("() => (a, b) => a", "(0 => (2 => a))"),
        ("5.add()", "5.add(0)"),
        ("1..2", "(1..2)"),
        ("10mm^2", "10Mm^2"),
        ("(10mm)^2", "(10Mm^1 Power 2)"),
        ("10mm^n", "(10Mm^1 Power n)"),
        ("a.in.part.for.step", "a.in.part.for.step"),
    ] {
        assert_eq!(expr_of(text), tree, "{text}");
    }
}

#[test]
fn words_are_keywords_only_where_the_grammar_takes_them() {
    const WORDS: &[&str] = &[
        "part", "view", "shade", "sheet", "param", "use", "set", "test", "export", "group",
        "assert", "pub", "as", "with", "step", "when", "fails",
    ];
    for word in WORDS {
        for text in [
            format!("{word} = 1"),
            format!("{word}: Number = 1"),
            format!("a = {word}"),
            format!("a = {word} + {word} * 2"),
            format!("a = f({word})"),
            format!("a = f({word} = 3)"),
            format!("a = {word}(3)"),
            format!("a = b.{word}(3).{word}"),
            format!("a = {{ {word} = 1, b }}"),
            format!("a = {word} => {word}"),
            format!("a = ({word}, b) => {word}"),
            format!("a = for {word} in {word} {{ {word} }}"),
            format!("fn {word}({word}) = {word}"),
            format!("part {word} = {word}"),
            format!("param {word} = {word} in 0..1"),
            format!("{word}.b(1)"),
            format!("use \"a\" {{ {word} as {word} }}"),
        ] {
            assert_eq!(words(&text), [""; 0], "{text}");
        }
    }
    for word in ["part", "view", "set", "test", "export", "use", "group", "step", "with"] {
        assert_eq!(expr_of(&format!("{word}(1)")), format!("{word}(1)"));
    }
}

#[test]
fn spans_are_exact() {
    let text = "é = f(a , b ) + \"x{ c+d }\"\n";
    let (program, _) = parse(SourceId(0), text);
    let ItemKind::Stmt { stmt, .. } = &program.items[0].kind else { panic!() };
    let StmtKind::Bind { value, .. } = &stmt.kind else { panic!() };
    let ExprKind::Binary(binary) = &value.kind else { panic!() };
    let ast::Binary { left, right, op_span, .. } = &**binary;
    let slice = |span: Span| &text[span.start as usize..span.end as usize];
    assert_eq!(slice(stmt.span), text.trim_end());
    assert_eq!(slice(left.span), "f(a , b )");
    assert_eq!(slice(*op_span), "+");
    let ExprKind::Text(string) = &right.kind else { panic!() };
    let Piece::Expr(hole) = &string.pieces[1] else { panic!() };
    assert_eq!((slice(string.span), slice(hole.span)), ("\"x{ c+d }\"", "c+d"));
}

#[test]
fn documentation_goes_to_its_item() {
    let text = "//! A lid.\n//! Round.\n/// Width\n/// over all.\npart w = 1\n\n// plain\nh = 2\n";
    let (program, diagnostics) = parse(SourceId(0), text);
    assert_eq!(diagnostics, []);
    assert_eq!(program.doc.as_deref(), Some("A lid.\nRound."));
    assert_eq!(program.items[0].doc.as_deref(), Some("Width\nover all."));
    assert_eq!(program.items[1].doc, None);
}

#[test]
fn names_are_compared_in_nfc() {
    let (program, _) = parse(SourceId(0), "u\u{308} = 1");
    let ItemKind::Stmt { stmt, .. } = &program.items[0].kind else { panic!() };
    let StmtKind::Bind { name, .. } = &stmt.kind else { panic!() };
    assert_eq!(&*name.text, "ü");
}

#[test]
fn one_mistake_is_one_message() {
    for (text, message) in [
        ("a = 5kg", "there is no unit `kg` `kg`"),
        ("a = box(1 2, 3)", "a `,` is missing `2`"),
        ("a = if w = 3 { 1 } else { 2 }", "`=` gives a name to a value `=`"),
        ("assert a = 1", "`=` gives a name to a value `=`"),
        ("d = a && b", "`&&` is not part of the language `&&`"),
        ("e = 5 mm", "the unit `mm` is apart from its number `mm`"),
        ("let f = 3", "`let` is not a word of this language `let`"),
        ("return 5", "`return` is not a word of this language `return`"),
        ("def f(x) = x", "`def` is not a word of this language `def`"),
        ("module g(x) { cube(x) }", "`module` is not a word of this language `module`"),
        ("a = 1; b = 2;\nc = 3;", "a statement ends with its line `;`"),
        ("for (i = [0:5]) { i }", "`for` takes a name here, not `(` `(`"),
        ("h = [0:5]", "`:` has no place here `:`"),
        ("difference() { a }", "a call takes no shapes in braces `{`"),
        ("translate([1, 2, 3]) cube(5)", "`translate` stands before its shape `cube`"),
        ("l = 1 m = 2", "two statements stand on one line `m`"),
        ("n = box(1, 2\no = 3", "this `(` is never closed `(`"),
        ("fn f() {\n    a = (1 + 2\n    a\n}\nb = 1", "this `(` is never closed `(`"),
        ("fn f() {\n    a\n\nb = 1", "this `{` is never closed `{`"),
        ("n = [1, (2, 3]", "this `(` is never closed `(`"),
        ("o = f(1]", "`(` is closed with `]` `]`"),
        ("o = f(1))\np = 2", "this `)` closes nothing `)`"),
        ("t = \"open\nu = 1", "this string is not closed on its line `\"open`"),
        ("t = \"open {a\nu = 1", "this string is not closed on its line `\"open {a`"),
        ("q = 1 +* 2", "nothing stands before `*` `*`"),
        ("q = 1 +\n", "nothing follows `+` `+`"),
        ("fn x()\n{\n  1\n}\na = 1", "a line end stands before `{` ``"),
        ("j = 1 < 2 < 3", "comparisons do not chain `<`"),
        ("a = /* open", "this comment is never closed `/*`"),
        ("in = 5", "`in` is a reserved word `in`"),
        ("test \"a\" { }", "found `}` where a statement is needed `}`"),
    ] {
        assert_eq!(words(text), [message], "{text}");
    }
}

#[test]
fn several_mistakes_are_several_messages() {
    assert_eq!(
        words("module g(x) { cube(x); }\na = b || !c\nd = f(1 2, [3 4])"),
        [
            "`module` is not a word of this language `module`",
            "a statement ends with its line `;`",
            "`||` is not part of the language `||`",
            "`!` is not part of the language `!`",
            "a `,` is missing `2`",
        ]
    );
    assert_eq!(words("a = [f(1 2), g(3 4), do { 1 + \n b = \n c }]").len(), 3);
}

#[test]
fn what_is_unaffected_survives() {
    let text =
        "a = (1 + )\npart b = box(1 2)\nfn f(x = 1\n    y\nc = 3\npub fn g() { h = }\nd = 4\n";
    let (program, diagnostics) = parse(SourceId(0), text);
    let names: Vec<String> = program
        .items
        .iter()
        .map(|item| match &item.kind {
            ItemKind::Output(output) => output.name.text.to_string(),
            ItemKind::Stmt { stmt, .. } => match &stmt.kind {
                StmtKind::Bind { name, .. } => name.text.to_string(),
                StmtKind::Fn(function) => function.name.text.to_string(),
                other => format!("{other:?}"),
            },
            other => format!("{other:?}"),
        })
        .collect();
    assert_eq!(names, ["a", "b", "f", "c", "g", "d"]);
    assert_eq!(diagnostics.len(), 4, "{diagnostics:?}");
}

/// The next number of a sequence that is the same on every machine (splitmix64).
fn random(seed: &mut u64) -> u64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*seed ^ (*seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The text with a few bytes dropped, doubled, swapped for others, or moved elsewhere.
fn mutated(text: &str, seed: &mut u64) -> Vec<u8> {
    const SPARE: &[u8] = b"()[]{}\"\\,.;=+-*/^&|!<>\n /1a:_\xff\0{{}}in";
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=random(seed) % 6 {
        let at = random(seed) as usize % bytes.len().max(1);
        let length = (random(seed) as usize % 9).min(bytes.len() - at);
        let spare = SPARE[random(seed) as usize % SPARE.len()];
        let piece = bytes[at..at + length].to_vec();
        match random(seed) % 4 {
            0 => drop(bytes.drain(at..at + length)),
            1 => bytes.insert(at, spare),
            2 => drop(bytes.splice(at..at, piece)),
            _ => bytes[at] = spare,
        }
    }
    bytes
}

#[test]
fn no_text_makes_the_parser_fail() {
    let sample = include_str!("../../../tests/grammar/language.kata");
    let strings = include_str!("../../../tests/grammar/STRING.kata");
    let mut seed = 7;
    for round in 0..2000 {
        let bytes = mutated(if round % 4 == 0 { strings } else { sample }, &mut seed);
        let text = String::from_utf8_lossy(&bytes);
        let (program, diagnostics) = parse(SourceId(0), &text);
        let inside = |span: Span| text.get(span.start as usize..span.end as usize).is_some();
        assert!(program.items.iter().all(|item| inside(item.span)), "{text}");
        let labels = diagnostics.iter().flat_map(|d| &d.labels);
        assert!(labels.into_iter().all(|label| inside(label.span)), "{text}");
        let _ = crate::syntax::decode(SourceId(0), &bytes);
    }
}
