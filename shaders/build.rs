//! Lists the WGSL files of all families, each with the common files that its first line includes.

use std::{env, error::Error, fmt::Write, fs, path::Path};

/// The first lines of a file that includes others: names of files in `common/`, in order.
const INCLUDE: &str = "// #include ";
/// The family of the passes of the renderer: they include files of their own folder, and are in a table of their own.
const RENDER: &str = "render";
/// A common file of this name in place of the one without it, for adapters with subgroup operations.
const SUBGROUP: &str = "_subgroup";

fn main() -> Result<(), Box<dyn Error>> {
    let root = env::var("CARGO_MANIFEST_DIR")?;
    let root = Path::new(&root);
    let (mut plain, mut subgroup, mut render) = (String::new(), String::new(), String::new());
    // Folders that come or go.
    println!("cargo::rerun-if-changed=.");
    for family in names(root, None)? {
        let is_source = ["common", "src"].contains(&family.as_str());
        println!("cargo::rerun-if-changed={family}");
        for file in if is_source { Vec::new() } else { names(&root.join(&family), Some("wgsl"))? } {
            let path = format!("{family}/{file}.wgsl");
            let text = fs::read_to_string(root.join(&path))?;
            let lists =
                text.lines().map_while(|line| line.strip_prefix(INCLUDE)).flat_map(|list| list.split(','));
            let common: Vec<&str> = lists.map(str::trim).filter(|name| !name.is_empty()).collect();
            if family == RENDER {
                let parts: Vec<String> =
                    common.iter().map(|name| format!("{RENDER}/parts/{name}.wgsl")).collect();
                render.write_str(&entry(&format!("{family}::{file}"), &parts, &path))?;
                continue;
            }
            let entry = |common: &[String]| {
                let rows = ["rows".to_owned()];
                let common = rows.iter().chain(common).map(|name| format!("common/{name}.wgsl"));
                entry(&format!("{family}::{file}"), &common.collect::<Vec<_>>(), &path)
            };
            let own: Vec<String> = common.iter().map(|&name| name.to_owned()).collect();
            plain.write_str(&entry(&own))?;
            let has_subgroup = |name: &str| root.join(format!("common/{name}{SUBGROUP}.wgsl")).exists();
            if own.iter().any(|name| has_subgroup(name)) {
                let replaced = |name: &String| {
                    if has_subgroup(name) { format!("{name}{SUBGROUP}") } else { name.clone() }
                };
                subgroup.write_str(&entry(&own.iter().map(replaced).collect::<Vec<_>>()))?;
            }
        }
    }
    let tables = format!(
        "/// All passes, by family, with the common files that each is built from.\n\
         pub static SHADERS: &[Shader] = &[{plain}];\n\n\
         /// The same passes with subgroup operations, for adapters that have them.\n\
         pub static SUBGROUP_SHADERS: &[Shader] = &[{subgroup}];\n\n\
         /// The passes of the renderer.\n\
         pub static RENDER_SHADERS: &[Shader] = &[{render}];\n"
    );
    fs::write(Path::new(&env::var("OUT_DIR")?).join("shaders.rs"), tables)?;
    Ok(())
}

/// Folders, or names of files with an extension, in order.
fn names(folder: &Path, extension: Option<&str>) -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let is_meant = match extension {
            Some(extension) => path.extension().is_some_and(|own| own == extension),
            None => path.is_dir(),
        };
        names.extend(path.file_stem().filter(|_| is_meant).map(|name| name.to_string_lossy().into_owned()));
    }
    names.sort();
    Ok(names)
}

/// A row of the table.
fn entry(name: &str, common: &[String], path: &str) -> String {
    let text = |path: &str| format!("include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/{path}\"))");
    let common: Vec<String> = common.iter().map(|path| text(path)).collect();
    let (own, parts) = (text(path), common.join(", "));
    let all = [common, vec![own.clone()]].concat().join(", ");
    format!("Shader {{ name: {name:?}, common: &[{parts}], own: {own}, source: concat!({all}) }},\n")
}
