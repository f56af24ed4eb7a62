//! Source texts by number, and the arithmetic of lines and columns.

use std::sync::Arc;

use super::span::{SourceId, Span};

/// One source text and the name that diagnostics show for it.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path relative to the project root with `/` between folders, or `std/...`, or `<stdin>`.
    pub path: Arc<str>,
    /// The whole text.
    pub text: Arc<str>,
}

/// Every source text of one session; a [`SourceId`] is its index.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    sources: Vec<Source>,
}

impl SourceMap {
    /// Adds a text and returns its number.
    pub fn add(&mut self, path: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> SourceId {
        self.sources.push(Source { path: path.into(), text: text.into() });
        SourceId(self.sources.len() as u32 - 1)
    }

    /// The text behind a number, if this map gave that number out.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.sources.get(id.0 as usize)
    }

    /// All texts in the order they were added.
    pub fn iter(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        self.sources.iter().enumerate().map(|(i, s)| (SourceId(i as u32), s))
    }

    /// The characters a span covers; empty where the span does not fit the text.
    pub fn slice(&self, span: Span) -> &str {
        self.get(span.source)
            .and_then(|s| s.text.get(span.start as usize..span.end as usize))
            .unwrap_or("")
    }

    /// Line and column of a byte, both from 1, the column in characters.
    ///
    /// ```
    /// use katachi::base::SourceMap;
    /// let mut map = SourceMap::default();
    /// let id = map.add("a.kata", "w = 1\n形 = 2\n");
    /// assert_eq!(map.line_column(id, 10), (2, 3));
    /// ```
    pub fn line_column(&self, id: SourceId, byte: u32) -> (usize, usize) {
        let Some(source) = self.get(id) else { return (1, 1) };
        let mut end = (byte as usize).min(source.text.len());
        while !source.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &source.text[..end];
        let line = before.matches('\n').count() + 1;
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        (line, before[start..].chars().count() + 1)
    }
}
