//! The WGSL twins of the kernels of sorb: text only, no dependencies.
//!
//! A twin has the path of its kernel: the twin of `sph::density` is `sph/density.wgsl`. A kernel that needs several
//! passes has further files beside it, and what several twins need is in `common/`. A file names what it needs of that in its
//! first line, `// #include grid, smoothing`. Which passes make up a kernel, and which buffers they are bound to, is in the
//! declaration of the kernel in `sorb-kernels`. The passes of the renderer are in `render/`, and what several of those need is in
//! `render/parts/`.

/// The WGSL source of one pass, complete: what it shares with others comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Name of the file, `family::name`.
    pub name: &'static str,
    /// What it shares with others, file by file.
    pub common: &'static [&'static str],
    /// What it has for itself.
    pub own: &'static str,
    /// WGSL text: all of that.
    pub source: &'static str,
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The prefix sums of the numbers of the threads of a group, by subgroup operations. No pass of a kernel: a device is tried
/// out with it.
pub static PROBE: Shader = Shader {
    name: "grid::probe",
    common: &[include_str!("../common/scan_subgroup.wgsl")],
    own: include_str!("probe.wgsl"),
    source: concat!(include_str!("../common/scan_subgroup.wgsl"), include_str!("probe.wgsl")),
};

/// The pass of that name with subgroup operations, if it has use for them.
#[must_use]
pub fn subgroup_shader(name: &str) -> Option<&'static Shader> {
    SUBGROUP_SHADERS.iter().find(|shader| shader.name == name)
}

/// The pass of the renderer of that name.
#[must_use]
pub fn render_shader(name: &str) -> Option<&'static Shader> {
    RENDER_SHADERS.iter().find(|shader| shader.name == name)
}

/// The pass of that name.
#[must_use]
pub fn shader(name: &str) -> Option<&'static Shader> {
    SHADERS.iter().find(|shader| shader.name == name)
}
