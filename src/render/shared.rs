//! Numbers that shaders know by name, so that they stand once.

use glam::Vec3;

/// A number as WGSL writes it.
pub(super) trait Literal: Sync {
    /// Type and value.
    fn wgsl(&self) -> (String, String);
}

impl Literal for f32 {
    fn wgsl(&self) -> (String, String) {
        ("f32".to_owned(), format!("{self:?}"))
    }
}

impl Literal for u32 {
    fn wgsl(&self) -> (String, String) {
        ("u32".to_owned(), format!("{self}u"))
    }
}

impl Literal for u8 {
    fn wgsl(&self) -> (String, String) {
        u32::from(*self).wgsl()
    }
}

impl Literal for usize {
    fn wgsl(&self) -> (String, String) {
        (*self as u32).wgsl()
    }
}

impl Literal for (f32, f32) {
    fn wgsl(&self) -> (String, String) {
        ("vec2<f32>".to_owned(), format!("vec2<f32>({:?}, {:?})", self.0, self.1))
    }
}

impl Literal for Vec3 {
    fn wgsl(&self) -> (String, String) {
        ("vec3<f32>".to_owned(), format!("vec3<f32>({:?}, {:?}, {:?})", self.x, self.y, self.z))
    }
}

impl<const COUNT: usize> Literal for [[f32; 3]; COUNT] {
    fn wgsl(&self) -> (String, String) {
        let kind = format!("array<vec3<f32>, {COUNT}>");
        let rows: Vec<String> = self.iter().map(|row| Vec3::from(*row).wgsl().1).collect();
        (kind.clone(), format!("{kind}({})", rows.join(", ")))
    }
}

/// A constant that shaders know, by the name of its file and its own.
pub(super) struct Constant {
    pub(super) name: &'static str,
    pub(super) value: &'static dyn Literal,
}

impl Constant {
    /// Its declaration.
    pub(super) fn wgsl(&self) -> String {
        let (kind, value) = self.value.wgsl();
        format!("const {}: {kind} = {value};\n", self.name)
    }
}

/// Constants of a file that shaders know by the name of the file and their own.
macro_rules! shared_with_shaders {
    ($file:ident: $($name:ident),+) => {
        pub(in crate::render) const CONSTANTS: &[crate::render::shared::Constant] = &[$(
            crate::render::shared::Constant {
                name: concat!(stringify!($file), "_", stringify!($name)),
                value: &$name,
            },
        )+];
    };
}
