//! `include/sorb.h` is what cbindgen makes of the sources.

use std::{env, fs, path::Path};

/// The order of the header: what is needed first comes first.
const SOURCES: [&str; 12] = [
    "failure",
    "options",
    "scene",
    "report",
    "world",
    "body",
    "column",
    "command",
    "change",
    "query",
    "state",
    "recording",
];

#[test]
fn the_header_is_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("the configuration");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in SOURCES {
        builder = builder.with_src(root.join(format!("src/{source}.rs")));
    }
    let mut made = Vec::new();
    builder.generate().expect("the sources").write(&mut made);
    let made = String::from_utf8(made).expect("UTF-8");
    let path = root.join("include/sorb.h");
    if env::var_os("UPDATE_HEADER").is_some() {
        fs::write(&path, &made).expect("a folder that can be written");
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == made,
        "run `UPDATE_HEADER=1 cargo test -p sorb-capi --test header`, and look at the header"
    );
    // Every entry is in it.
    for entry in entries(root) {
        assert!(made.contains(&format!("{entry}(")), "{entry} is missing");
    }
}

/// Names of all functions of the library for C.
fn entries(root: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for file in fs::read_dir(root.join("src")).expect("the sources") {
        let text = fs::read_to_string(file.expect("a file").path()).expect("a text");
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if line.trim() == "#[unsafe(no_mangle)]" {
                let function = lines.next().unwrap_or_default();
                let name = function.split("fn ").nth(1).and_then(|rest| rest.split('(').next());
                names.push(name.expect("a function").to_owned());
            }
        }
    }
    assert!(names.len() > 40, "{names:?}");
    names
}
