//! What a pass does to the buffers that it is bound to, read off its text.

use sorb_shaders::Shader;

use crate::gpu::{
    pipeline::{Binding, bindings},
    twins::Pass,
};

/// The use of a buffer by a pass.
#[derive(Clone, Debug)]
pub(super) struct Access {
    pub(super) binding: Binding,
    /// Name of the buffer.
    pub(super) buffer: &'static str,
    /// Whether a thread uses only the row of its own.
    is_own_row: bool,
    /// Whether it only takes part in finding largest values, in any order.
    is_largest: bool,
}

/// Whether two passes may be in one dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Order {
    /// In any order.
    Any,
    /// One after the other, by the threads of the same rows.
    ByRow,
    /// One after the other.
    Whole,
}

/// The uses of all buffers of a pass.
pub(super) fn accesses(pass: &Pass, shader: &'static Shader) -> Vec<Access> {
    let text = uses(shader.source);
    let access = |binding: Binding| {
        let name = binding.name;
        Access {
            buffer: pass.buffer(name),
            is_own_row: occurrences(&text, name)
                .all(|(_, after)| after.starts_with("[row]") || after.starts_with("[share.row]")),
            is_largest: occurrences(&text, name).all(|(before, _)| before.ends_with("atomicMax(&")),
            binding,
        }
    };
    bindings(shader.source).into_iter().map(access).collect()
}

/// How the accesses of two passes to the same buffers have to be ordered.
pub(super) fn order(before: &[Access], after: &[Access]) -> Order {
    let pairs = before.iter().flat_map(|a| after.iter().map(move |b| (a, b)));
    let of_pair = |(a, b): (&Access, &Access)| {
        let is_written = a.binding.is_written() || b.binding.is_written();
        let conflict = a.buffer == b.buffer && is_written && !(a.is_largest && b.is_largest);
        if !conflict {
            Order::Any
        } else if a.is_own_row && b.is_own_row {
            Order::ByRow
        } else {
            Order::Whole
        }
    };
    pairs.map(of_pair).max().unwrap_or(Order::Any)
}

/// A text without comments and without the lines that bind buffers.
fn uses(source: &str) -> String {
    without_comments(source)
        .lines()
        .filter(|line| !line.starts_with("@group("))
        .map(|line| format!("{line}\n"))
        .collect()
}

/// A text without comments.
pub(super) fn without_comments(source: &str) -> String {
    source.lines().map(|line| format!("{}\n", line.split("//").next().unwrap_or(""))).collect()
}

/// Where a word stands: what is before and after it. Fields of structs are none.
pub(super) fn occurrences<'t>(text: &'t str, word: &'t str) -> impl Iterator<Item = (&'t str, &'t str)> {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    text.match_indices(word).map(move |(at, _)| (&text[..at], &text[at + word.len()..])).filter(
        move |(before, after)| {
            !before.ends_with(|letter| is_part(letter) || letter == '.') && !after.starts_with(is_part)
        },
    )
}

/// A text with other words.
pub(super) fn replaced(text: &str, word: &str, by: &str) -> String {
    let mut all = String::new();
    let mut from = 0;
    for (before, _) in occurrences(text, word) {
        all.push_str(&text[from..before.len()]);
        all.push_str(by);
        from = before.len() + word.len();
    }
    all + &text[from..]
}
