//! Keys such as `sponges[0].permeability`, as text and as parts.

/// Parts of a key; `a[0].b` and `a.0.b` are the same key. `None` where a part is empty.
pub(super) fn parts(key: &str) -> Option<Vec<String>> {
    let dotted = key.trim().replace('[', ".").replace(']', "");
    let parts: Vec<String> = dotted.split('.').map(|part| part.trim().to_owned()).collect();
    parts.iter().all(|part| !part.is_empty()).then_some(parts)
}

/// Key of a member of a table.
pub(super) fn member(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
}

/// Key of an element of an array.
pub(super) fn element(array: &str, index: usize) -> String {
    format!("{array}[{index}]")
}
