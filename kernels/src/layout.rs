//! What a device shares with the host. Constants, enumerations and structs are declared in Rust, and WGSL text, sizes, offsets and
//! words follow from the declarations.
//!
//! - `constants!` around constants: shaders know them by the same names.
//! - `enumeration!` around an enum: its variants have numbers, and `Bound::SpongeSpeed` is `BOUND_SPONGE_SPEED` in WGSL.
//! - `layout!` around a struct: a struct of WGSL with the same fields. Each begins and ends at a multiple of 16 bytes, as uniform buffers
//!   ask for, and so does each vector. What is between the fields is zero.
//!
//! `gpu::wgsl` puts the text of all of them together.

/// Declares constants, and `CONSTANTS`, a list of them for shaders.
macro_rules! constants {
    ($($(#[$meta:meta])* $visible:vis const $NAME:ident: $kind:ty = $value:expr;)*) => {
        $($(#[$meta])* $visible const $NAME: $kind = $value;)*

        /// What shaders know of this module.
        #[cfg(feature = "gpu")]
        pub(crate) const CONSTANTS: &[$crate::gpu::layout::Constant] =
            &[$($crate::gpu::layout::Constant { name: stringify!($NAME), value: &$NAME }),*];
    };
}
pub(crate) use constants;

/// Declares an enumeration, numbered from 0.
macro_rules! enumeration {
    (
        $(#[$meta:meta])*
        $visible:vis enum $Name:ident { $($(#[$variant_meta:meta])* $Variant:ident),* $(,)? }
    ) => {
        $(#[$meta])*
        $visible enum $Name { $($(#[$variant_meta])* $Variant),* }

        impl $Name {
            /// All of them; the place of each is its number.
            $visible const ALL: &'static [Self] = &[$(Self::$Variant),*];
        }

        #[cfg(feature = "gpu")]
        impl $crate::gpu::layout::Enumeration for $Name {
            const NAME: &'static str = stringify!($Name);
            const VARIANTS: &'static [&'static str] = &[$(stringify!($Variant)),*];
        }

        #[cfg(feature = "gpu")]
        impl $crate::gpu::layout::Value for $Name {
            const TYPE: &'static str = "u32";
            const WORDS: usize = 1;

            fn put(&self, words: &mut [u32]) {
                words[0] = *self as u32;
            }

            /// The first for numbers that none of them has.
            fn take(words: &[u32]) -> Self {
                Self::ALL.get(words[0] as usize).copied().unwrap_or(Self::ALL[0])
            }
        }
    };
}
pub(crate) use enumeration;

/// Declares a struct, with another name in WGSL where it has one.
macro_rules! layout {
    (
        $(#[$meta:meta])*
        $visible:vis struct $Name:ident $(as $Other:ident)? {
            $($(#[$field_meta:meta])* $field_visible:vis $field:ident: $kind:ty),* $(,)?
        }
    ) => {
        $(#[$meta])*
        $visible struct $Name { $($(#[$field_meta])* $field_visible $field: $kind),* }

        #[cfg(feature = "gpu")]
        impl $crate::gpu::layout::Struct for $Name {
            const FIELDS: &'static [$crate::gpu::layout::Field] =
                &$crate::gpu::layout::placed([$($crate::gpu::layout::Field::of::<$kind>(stringify!($field))),*]);
        }

        #[cfg(feature = "gpu")]
        impl $crate::gpu::layout::Value for $Name {
            const TYPE: &'static str = $crate::layout::layout!(@name $($Other)? $Name);
            const WORDS: usize = $crate::gpu::layout::words_of(<Self as $crate::gpu::layout::Struct>::FIELDS);
            const ALIGN: usize = 4;

            fn put(&self, words: &mut [u32]) {
                let mut end = 0;
                $($crate::gpu::layout::put_next(&self.$field, words, &mut end);)*
            }

            fn take(words: &[u32]) -> Self {
                let mut end = 0;
                Self { $($field: $crate::gpu::layout::take_next(words, &mut end)),* }
            }
        }
    };
    (@name $first:ident $($rest:ident)?) => { stringify!($first) };
}
pub(crate) use layout;
