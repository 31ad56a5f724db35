//! The WGSL twins of the kernels of sorb: text only, no dependencies.
//!
//! A twin has the path of its kernel: the twin of `sph::density` is `sph/density.wgsl`. Kernels without a
//! twin run on the CPU.

/// The WGSL source of one kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Name of the kernel, `family::name`.
    pub kernel: &'static str,
    /// WGSL text.
    pub source: &'static str,
}

/// All twins, ordered by the name of the kernel.
pub static SHADERS: &[Shader] = &[];

/// The twin of the named kernel, if it has one.
#[must_use]
pub fn shader(kernel: &str) -> Option<&'static Shader> {
    SHADERS.iter().find(|shader| shader.kernel == kernel)
}
