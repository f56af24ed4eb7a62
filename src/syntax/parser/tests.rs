//! The parser on whole texts.

use super::*;

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
        repeated("1+", count, "1", ""),
        repeated("1 and ", count, "1", ""),
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
