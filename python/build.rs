//! A module of Python is not linked with the interpreter, which macOS must be told.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    pyo3_build_config::add_extension_module_link_args();
}
