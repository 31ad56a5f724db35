//! A kernel uses no other kernel: what several share has a file of its own.

use std::{fs, path::Path};

use crate::KERNELS;

/// Splits the parts of a list at commas outside of braces.
fn parts(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (place, letter) in list.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..place]);
                start = place + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[start..]);
    parts
}

/// The paths of a tree of imports.
fn paths(tree: &str, before: &str, all: &mut Vec<String>) {
    for part in parts(tree) {
        match part.split_once('{') {
            Some((head, rest)) => {
                paths(rest.strip_suffix('}').unwrap_or(rest), &format!("{before}{head}"), all)
            }
            None => all.push(format!("{before}{part}")),
        }
    }
}

/// Kernels that the source of a kernel imports, or calls by a path from its family.
fn others(name: &str, source: &str) -> Vec<&'static str> {
    let family = name.split_once("::").map_or("", |(family, _)| family);
    let lines = source.lines().map(|line| line.split("//").next().unwrap_or_default());
    let code: String = lines.collect::<Vec<_>>().join(" ");
    let mut used = Vec::new();
    for statement in code.split("use ").skip(1).filter_map(|rest| rest.split_once(';')) {
        let tree: String = statement.0.split_whitespace().collect();
        paths(&tree, "", &mut used);
    }
    let words = code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_' || letter == ':'));
    used.extend(words.map(str::to_owned));
    let is_used = |other: &&str| {
        let own = other.strip_prefix(&format!("{family}::")).map(|own| format!("super::{own}::"));
        let full = format!("crate::{other}::");
        used.iter()
            .any(|path| path.starts_with(&full) || own.as_ref().is_some_and(|own| path.starts_with(own)))
    };
    KERNELS.iter().map(|kernel| kernel.name).filter(|other| *other != name).filter(is_used).collect()
}

#[test]
fn kernels_use_no_other_kernel() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for kernel in KERNELS {
        let file = sources.join(kernel.name.replace("::", "/")).with_extension("rs");
        let source = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert_eq!(others(kernel.name, &source), [""; 0], "{}", kernel.name);
    }
}

#[test]
fn imports_of_other_kernels_are_found() {
    let found = |source| others("sph::sweep", source);
    assert_eq!(found("use super::{container::inside, advect::STOP};"), ["sph::advect"]);
    assert_eq!(
        found("use crate::{\n    cpu::Cpu,\n    pbd::{stars::Piece, predict::guess},\n};"),
        ["pbd::predict"]
    );
    assert_eq!(found("fn cpu() { super::kick::run(); }"), ["sph::kick"]);
    assert_eq!(found("use crate::sweep::Met; // use super::advect::STOP;"), [""; 0]);
}
