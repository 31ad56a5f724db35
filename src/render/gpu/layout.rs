//! Uniform values: a struct of Rust, its declaration in WGSL and its words.

use glam::Vec3;

/// Words of four bytes that a row of a uniform buffer has.
const ROW: usize = 4;

/// A value that shaders have.
pub(super) trait Field {
    /// Its type in WGSL.
    const TYPE: &'static str;
    /// Words of which its place is a multiple.
    const ALIGN: usize;

    /// Appends its words.
    fn write(&self, words: &mut Vec<u32>);
}

impl Field for f32 {
    const TYPE: &'static str = "f32";
    const ALIGN: usize = 1;

    fn write(&self, words: &mut Vec<u32>) {
        words.push(self.to_bits());
    }
}

impl Field for u32 {
    const TYPE: &'static str = "u32";
    const ALIGN: usize = 1;

    fn write(&self, words: &mut Vec<u32>) {
        words.push(*self);
    }
}

impl Field for Vec3 {
    const TYPE: &'static str = "vec3<f32>";
    const ALIGN: usize = ROW;

    fn write(&self, words: &mut Vec<u32>) {
        words.extend(self.to_array().map(f32::to_bits));
    }
}

impl Field for [u32; 3] {
    const TYPE: &'static str = "vec3<u32>";
    const ALIGN: usize = ROW;

    fn write(&self, words: &mut Vec<u32>) {
        words.extend(self);
    }
}

impl Field for [f32; 4] {
    const TYPE: &'static str = "vec4<f32>";
    const ALIGN: usize = ROW;

    fn write(&self, words: &mut Vec<u32>) {
        words.extend(self.map(f32::to_bits));
    }
}

/// Appends a value at its place.
pub(super) fn append<F: Field>(words: &mut Vec<u32>, field: &F) {
    words.resize(words.len().next_multiple_of(F::ALIGN), 0);
    field.write(words);
}

/// Fills the last row.
pub(super) fn finish(mut words: Vec<u32>) -> Vec<u32> {
    words.resize(words.len().next_multiple_of(ROW), 0);
    words
}

/// Declares a struct that shaders know by the same name and fields.
macro_rules! uniform {
    ($(#[$meta:meta])* struct $name:ident { $($(#[$field_meta:meta])* $field:ident: $kind:ty,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, Default)]
        pub(super) struct $name {
            $($(#[$field_meta])* pub(super) $field: $kind,)+
        }

        impl $name {
            /// Its declaration in WGSL.
            pub(super) fn wgsl() -> String {
                let mut text = concat!("struct ", stringify!($name), " {\n").to_owned();
                $(text.push_str(concat!("    ", stringify!($field), ": "));
                text.push_str(<$kind as crate::render::gpu::layout::Field>::TYPE);
                text.push_str(",\n");)+
                text.push_str("}\n");
                text
            }

            /// Its words, where WGSL has them.
            pub(super) fn words(&self) -> Vec<u32> {
                let mut words = Vec::new();
                $(crate::render::gpu::layout::append(&mut words, &self.$field);)+
                crate::render::gpu::layout::finish(words)
            }
        }
    };
}

pub(super) use uniform;
