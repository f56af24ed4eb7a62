//! Nothing that is written makes evaluation panic or hang: sources with tokens dropped, doubled,
//! swapped and replaced.

use katachi::{
    eval::{Limits, library::Index},
    syntax,
};

use super::host::run_limited;

/// A small sequence of numbers that is the same in every run (Knuth's MMIX generator).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// Words, numbers, strings and single signs.
fn tokens(text: &str) -> Vec<&str> {
    let kind = |c: char| {
        if c.is_alphanumeric() || c == '_' {
            0
        } else if c == ' ' {
            1
        } else {
            2
        }
    };
    let mut found = vec![];
    let mut start = 0;
    let mut previous = None;
    for (at, c) in text.char_indices() {
        if previous.is_some_and(|previous| previous != kind(c) || kind(c) == 2) {
            found.push(&text[start..at]);
            start = at;
        }
        previous = Some(kind(c));
    }
    found.push(&text[start..]);
    found
}

fn mutant(dice: &mut Dice, source: &[&str], spare: &[&str]) -> String {
    let mut tokens: Vec<&str> = source.to_vec();
    for _ in 0..=dice.below(3) {
        let at = dice.below(tokens.len());
        match dice.below(5) {
            0 => drop(tokens.remove(at)),
            1 => tokens.insert(at, tokens[dice.below(source.len().min(tokens.len()))]),
            2 => tokens[at] = spare[dice.below(spare.len())],
            3 => tokens.insert(at, spare[dice.below(spare.len())]),
            _ => {
                let other = dice.below(tokens.len());
                tokens.swap(at, other);
            }
        }
        if tokens.is_empty() {
            tokens.push("1");
        }
    }
    tokens.concat()
}

const SOURCES: &[&str] = &[
    "param w: Length = 60mm in 20mm..120mm step 1mm\npart p = box(w, 3, 4) - cylinder(d = 2, h = 9).move(z = -1)\nassert volume(p) > 0mm^3, \"{w}\"",
    "fn f(n, k = 2) = if n < k { 1 } else { n * f(n - 1) }\na = [for i, j in 0..<5 if i % 2 == 0 { f(i) }, { x = 1 }]\npub b = a[0][-1] + f(3, k = 1)\npart p = sphere(b)",
    "use \"std/metric\" as m\nuse \"std/metric\" { clearance as c }\nr = { d = c(5mm), ..m.nut(5mm) }\nexport \"{r.d}.stl\" = { p, q = p.move([1, 2, 3]) }\npart p = rect(r.d, 2).extrude(3, twist = 5deg)",
    "g = (a, b) => a ++ b\ns = fold([\"x\", \"y\"], \"\", g)\ntest \"t\" fails \"no\" { assert s == \"xy\", \"no\" }\nset tolerance = 0.1\nhull([box(1, 1, 1), sphere(2)])\nx = do {\n y = 1..3\n sum(y) / 2\n}",
];

#[test]
fn mutants_are_refused_in_words() {
    let names: Vec<&str> = Index::get().names().collect();
    let mut spare = vec![
        "(", ")", "[", "]", "{", "}", "\"", "..", ",", "=", "=>", "-", "0", "1e300", "mm", "NONE",
        "self", "\n", "if", "for", "in", "x", "..<", "p", "w", ".", "^", "&",
    ];
    spare.extend(names);
    let limits = Limits { steps: 20_000, values: 50_000, depth: 200 };
    let mut dice = Dice(7);
    for round in 0..3000 {
        let source = tokens(SOURCES[round % SOURCES.len()]);
        let text = mutant(&mut dice, &source, &spare);
        let ran = run_limited(&[("main.kata", &text)], &[("w", "30mm")][..round % 2], limits);
        let (_, syntax) = syntax::parse(katachi::base::SourceId(0), &text);
        assert!(syntax.is_empty() || !ran.diagnostics.is_empty(), "{text}");
    }
}
