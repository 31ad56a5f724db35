//! Line and column of a key in a TOML file.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::key;

/// Line and column of a byte, both from 1, the column in characters.
pub(super) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    let line = before.matches('\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

/// Place of a key, or of the innermost table around it that is present; `None` for a key whose first part is absent.
pub(super) fn locate(text: &str, key: &str) -> Option<(usize, usize)> {
    let document = DeTable::parse(text).ok()?;
    let mut parts = key::parts(key)?.into_iter();
    let (mut byte, mut value) = entry(document.get_ref(), &parts.next()?)?;
    for part in parts {
        let inner = match value {
            DeValue::Table(table) => entry(table, &part),
            DeValue::Array(array) => {
                let element = part.parse::<usize>().ok().and_then(|index| array.get(index));
                element.map(|element| (element.span().start, element.get_ref()))
            }
            _ => None,
        };
        let Some(inner) = inner else { break };
        (byte, value) = inner;
    }
    Some(line_and_column(text, byte))
}

/// Place of the key and the value of a member.
fn entry<'a, 'i>(table: &'a DeTable<'i>, name: &str) -> Option<(usize, &'a DeValue<'i>)> {
    let (key, value): (_, &Spanned<DeValue<'i>>) =
        table.iter().find(|(key, _)| key.get_ref().as_ref() == name)?;
    Some((key.span().start, value.get_ref()))
}
