//! Values of buffers, and what WGSL knows of constants, enumerations and structs: what the declarations of [`crate::layout`] expand to.

use std::fmt::Debug;

/// A number as WGSL writes it.
pub(crate) trait Literal: Debug + Sync {
    /// Type and value; no type where WGSL finds it, or is to take the value as it is, without rounding it to f32.
    fn wgsl(&self) -> (Option<&'static str>, String);

    /// Its bits in one word, if it has one.
    #[cfg(test)]
    fn bits(&self) -> Option<u32> {
        None
    }
}

impl Literal for f32 {
    fn wgsl(&self) -> (Option<&'static str>, String) {
        (Some("f32"), format!("{self:?}"))
    }

    #[cfg(test)]
    fn bits(&self) -> Option<u32> {
        Some(self.to_bits())
    }
}

impl Literal for f64 {
    fn wgsl(&self) -> (Option<&'static str>, String) {
        (None, format!("{self:?}"))
    }
}

impl Literal for u32 {
    fn wgsl(&self) -> (Option<&'static str>, String) {
        (Some("u32"), format!("{self}u"))
    }

    #[cfg(test)]
    fn bits(&self) -> Option<u32> {
        Some(*self)
    }
}

impl Literal for usize {
    fn wgsl(&self) -> (Option<&'static str>, String) {
        (*self as u32).wgsl()
    }

    #[cfg(test)]
    fn bits(&self) -> Option<u32> {
        Some(*self as u32)
    }
}

impl<const COUNT: usize> Literal for [[usize; 4]; COUNT] {
    fn wgsl(&self) -> (Option<&'static str>, String) {
        let row = |[x, y, z, w]: &[usize; 4]| format!("vec4<u32>({x}u, {y}u, {z}u, {w}u), ");
        (None, format!("array<vec4<u32>, {COUNT}>({})", self.iter().map(row).collect::<String>()))
    }
}

/// A constant that shaders know.
#[derive(Debug)]
pub(crate) struct Constant {
    pub(crate) name: &'static str,
    pub(crate) value: &'static dyn Literal,
}

impl Constant {
    /// Its declaration.
    pub(crate) fn wgsl(&self) -> String {
        let (kind, value) = self.value.wgsl();
        let kind = kind.map(|kind| format!(": {kind}")).unwrap_or_default();
        format!("const {}{kind} = {value};\n", self.name)
    }
}

/// An enumeration that shaders know.
pub(crate) trait Enumeration {
    const NAME: &'static str;
    const VARIANTS: &'static [&'static str];

    /// Declarations of the numbers of its variants, and how many there are.
    fn wgsl() -> String {
        let number = |(number, variant): (usize, &&str)| {
            format!("const {}_{}: u32 = {number}u;\n", upper_case(Self::NAME), upper_case(variant))
        };
        let count = format!("const {}_COUNT: u32 = {}u;\n", upper_case(Self::NAME), Self::VARIANTS.len());
        Self::VARIANTS.iter().enumerate().map(number).chain([count]).collect()
    }
}

/// `SpongeSpeed` as `SPONGE_SPEED`.
fn upper_case(name: &str) -> String {
    let mut upper = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !upper.is_empty() {
            upper.push('_');
        }
        upper.push(letter.to_ascii_uppercase());
    }
    upper
}

/// Words of four bytes that structs and vectors begin at a multiple of.
pub(crate) const ROW: usize = 4;
/// Bytes of a word.
pub(crate) const WORD_BYTES: u64 = 4;
/// Bytes of a row of four floats.
pub(crate) const ROW_BYTES: u64 = WORD_BYTES * ROW as u64;

/// A value of a buffer.
pub(crate) trait Value: Sized {
    /// Its type in WGSL.
    const TYPE: &'static str;
    /// Words of four bytes.
    const WORDS: usize;
    /// Words of which its place is a multiple.
    const ALIGN: usize = 1;
    /// Bytes.
    const BYTES: u64 = WORD_BYTES * Self::WORDS as u64;

    /// Writes it to as many words.
    fn put(&self, words: &mut [u32]);

    /// Reads it from as many words.
    fn take(words: &[u32]) -> Self;

    /// Its words.
    fn words(&self) -> Vec<u32> {
        let mut words = vec![0; Self::WORDS];
        self.put(&mut words);
        words
    }
}

/// Values of one word each.
macro_rules! words {
    ($($Type:ty: $name:literal, $to_word:expr, $of_word:expr;)*) => {
        $(impl Value for $Type {
            const TYPE: &'static str = $name;
            const WORDS: usize = 1;

            fn put(&self, words: &mut [u32]) {
                words[0] = $to_word(*self);
            }

            fn take(words: &[u32]) -> Self {
                $of_word(words[0])
            }
        })*
    };
}

words! {
    f32: "f32", f32::to_bits, f32::from_bits;
    u32: "u32", u32::from, u32::from;
    bool: "u32", u32::from, |word| word != 0;
}

/// Vectors, and rows of them.
macro_rules! vectors {
    ($([$Element:ty; $count:literal]: $name:literal;)*) => {
        $(impl Value for [$Element; $count] {
            const TYPE: &'static str = $name;
            const WORDS: usize = $count * <$Element>::WORDS;
            const ALIGN: usize = ROW;

            fn put(&self, words: &mut [u32]) {
                self.iter().zip(words.chunks_exact_mut(<$Element>::WORDS)).for_each(|(own, words)| own.put(words));
            }

            fn take(words: &[u32]) -> Self {
                std::array::from_fn(|index| Value::take(&words[index * <$Element>::WORDS..][..<$Element>::WORDS]))
            }
        })*
    };
}

vectors! {
    [f32; 3]: "vec3<f32>";
    [f32; 4]: "vec4<f32>";
    [u32; 3]: "vec3<u32>";
    [u32; 4]: "vec4<u32>";
    [u32; 8]: "array<vec4<u32>, 2>";
    [[u32; 4]; 3]: "array<vec4<u32>, 3>";
    [bool; 3]: "vec3<u32>";
}

/// A field of a struct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Field {
    pub(crate) name: &'static str,
    kind: &'static str,
    /// Words before it.
    pub(crate) place: usize,
    pub(crate) words: usize,
    align: usize,
}

impl Field {
    /// A field that has no place yet.
    pub(crate) const fn of<V: Value>(name: &'static str) -> Self {
        Self { name, kind: V::TYPE, place: 0, words: V::WORDS, align: V::ALIGN }
    }

    const fn end(&self) -> usize {
        self.place + self.words
    }
}

/// Fields one after the other.
pub(crate) const fn placed<const COUNT: usize>(mut fields: [Field; COUNT]) -> [Field; COUNT] {
    let mut index = 0;
    let mut end = 0_usize;
    while index < COUNT {
        fields[index].place = end.next_multiple_of(fields[index].align);
        end = fields[index].end();
        index += 1;
    }
    fields
}

/// A struct that shaders know.
pub(crate) trait Struct: Value {
    const FIELDS: &'static [Field];
    /// What all of it looks like.
    const SHAPE: Shape = Shape {
        name: Self::TYPE,
        fields: Self::FIELDS,
        #[cfg(test)]
        words: Self::WORDS,
    };
}

/// Name, fields and words of a struct.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    pub(crate) fields: &'static [Field],
    #[cfg(test)]
    pub(crate) words: usize,
}

impl Shape {
    /// Its declaration. A struct has the alignment of its first field, which naga does not keep for fields of that type.
    pub(crate) fn wgsl(&self) -> String {
        let field = |field: &Field| {
            let align = if field.place == 0 || field.align == ROW { "@align(16) " } else { "" };
            format!("    {align}{}: {},\n", field.name, field.kind)
        };
        let fields: String = self.fields.iter().map(field).collect();
        format!("struct {} {{\n{fields}}}\n", self.name)
    }
}

/// Words of a struct.
pub(crate) const fn words_of(fields: &[Field]) -> usize {
    match fields {
        [] => 0,
        [.., last] => last.end().next_multiple_of(ROW),
    }
}

/// Words before a field of a struct; constants of a field that there is not do not compile.
pub(crate) const fn place_of<S: Struct>(name: &str) -> usize {
    let mut index = 0;
    while index < S::FIELDS.len() {
        if is_same(S::FIELDS[index].name.as_bytes(), name.as_bytes()) {
            return S::FIELDS[index].place;
        }
        index += 1;
    }
    panic!("no such field")
}

/// As `==`, which is not for constants.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    match (a, b) {
        ([], []) => true,
        ([first, a @ ..], [other, b @ ..]) => *first == *other && is_same(a, b),
        _ => false,
    }
}

/// Writes a field behind those that end at a word.
pub(crate) fn put_next<V: Value>(value: &V, words: &mut [u32], end: &mut usize) {
    let start = end.next_multiple_of(V::ALIGN);
    *end = start + V::WORDS;
    value.put(&mut words[start..*end]);
}

/// Reads a field behind those that end at a word.
pub(crate) fn take_next<V: Value>(words: &[u32], end: &mut usize) -> V {
    let start = end.next_multiple_of(V::ALIGN);
    *end = start + V::WORDS;
    V::take(&words[start..*end])
}

/// The value all words of which are zero.
pub(crate) fn zero<V: Value>() -> V {
    V::take(&vec![0; V::WORDS])
}
