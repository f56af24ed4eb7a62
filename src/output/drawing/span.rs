//! How many faces are in front of a line, as a step function along it.

/// A part of a line with the same number of faces in front of all of it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Span {
    /// Where it begins, 0 to 1.
    pub from: f64,
    /// Where it ends, 0 to 1.
    pub to: f64,
    /// Nishita's order of invisibility: front faces before it; 0 is visible.
    pub order: u32,
}

/// A place where the order changes, and by how much.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Step {
    /// Place along the line.
    pub at: f64,
    /// Change of the order.
    pub by: i32,
}

/// The spans between steps in [0, 1], starting from an order. Spans shorter than `dust` are given to their
/// neighbours: they are gaps of rounding between faces that share an edge. A line of less than two such lengths is one
/// span, that of its middle.
pub fn spans(steps: &mut [Step], start: i32, dust: f64, out: &mut Vec<Span>) {
    steps.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
    if dust >= 0.5 {
        let before = steps.iter().take_while(|step| step.at <= 0.5);
        let order = start + before.map(|step| step.by).sum::<i32>();
        return out.push(Span { from: 0.0, to: 1.0, order: order.max(0) as u32 });
    }
    let first = out.len();
    let (mut order, mut from) = (start, 0.0);
    for step in steps.iter() {
        let at = step.at.min(1.0);
        if at - from > dust {
            append(out, first, Span { from, to: at, order: order.max(0) as u32 });
            from = at;
        }
        order += step.by;
    }
    if 1.0 - from > dust || out.len() == first {
        append(out, first, Span { from, to: 1.0, order: order.max(0) as u32 });
    } else {
        out[first..].last_mut().expect("one was appended").to = 1.0;
    }
}

/// The spans of a line behind what two sets of faces hide of it.
pub fn sum(one: &[Span], other: &[Span]) -> Vec<Span> {
    let (mut out, mut i, mut k, mut from) = (vec![], 0, 0, 0.0);
    while let (Some(a), Some(b)) = (one.get(i), other.get(k)) {
        let to = a.to.min(b.to);
        append(&mut out, 0, Span { from, to, order: a.order + b.order });
        (i, k) = (i + usize::from(a.to <= to), k + usize::from(b.to <= to));
        from = to;
    }
    out
}

/// Makes one span of neighbours that are hidden, by however many faces: of order 1.
pub fn unite(spans: &mut Vec<Span>) {
    spans.iter_mut().for_each(|span| span.order = span.order.min(1));
    spans.dedup_by(|span, before| {
        let alike = span.order == before.order;
        if alike {
            before.to = span.to;
        }
        alike
    });
}

/// Appends a span, or lengthens the last one from place `first` on when the order stays the same.
fn append(out: &mut Vec<Span>, first: usize, span: Span) {
    match out[first..].last_mut() {
        Some(last) if last.order == span.order => last.to = span.to,
        _ => out.push(span),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_become_spans_without_dust() {
        let mut steps = [
            Step { at: 0.5, by: -1 },
            Step { at: 0.25, by: 1 },
            Step { at: 0.5 + 1e-14, by: 1 },
            Step { at: 0.75, by: -1 },
        ];
        let mut out = vec![];
        spans(&mut steps, 0, 1e-12, &mut out);
        let expected = [(0.0, 0.25, 0), (0.25, 0.75, 1), (0.75, 1.0, 0)];
        assert_eq!(out.iter().map(|s| (s.from, s.to, s.order)).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn hidden_spans_are_one_where_they_are_not_counted() {
        let span = |from, to, order| Span { from, to, order };
        let mut spans =
            vec![span(0.0, 0.2, 0), span(0.2, 0.3, 1), span(0.3, 0.7, 4), span(0.7, 1.0, 0)];
        unite(&mut spans);
        assert_eq!(spans, [span(0.0, 0.2, 0), span(0.2, 0.7, 1), span(0.7, 1.0, 0)]);
    }

    #[test]
    fn a_line_of_dust_is_hidden_as_its_middle_is() {
        let mut steps = [-2.0, 0.1, 0.2, 3.0].map(|at| Step { at, by: 0 });
        (steps[0].by, steps[1].by, steps[2].by, steps[3].by) = (1, -1, 1, -1);
        let mut out = vec![];
        spans(&mut steps, 0, 0.6, &mut out);
        assert_eq!(out, [Span { from: 0.0, to: 1.0, order: 1 }]);
    }

    #[test]
    fn what_two_sets_of_faces_hide_is_added() {
        let span = |from, to, order| Span { from, to, order };
        let one = [span(0.0, 0.5, 1), span(0.5, 1.0, 0)];
        let other = [span(0.0, 0.25, 0), span(0.25, 0.5, 2), span(0.5, 1.0, 1)];
        let all = [span(0.0, 0.25, 1), span(0.25, 0.5, 3), span(0.5, 1.0, 1)];
        assert_eq!(sum(&one, &other), all);
    }

    #[test]
    fn a_line_without_steps_is_one_span() {
        let mut out = vec![];
        spans(&mut [], 2, 1e-12, &mut out);
        assert_eq!(out, [Span { from: 0.0, to: 1.0, order: 2 }]);
    }
}
