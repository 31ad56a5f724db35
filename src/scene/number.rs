//! Numbers inside fields: how validation visits them and how messages print them.

use glam::{UVec3, Vec3};

/// A field that consists of numbers.
pub(super) trait Numbers {
    /// Calls `each` with the key and the value of every number, `key` being the key of the whole field.
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32));
}

impl Numbers for f32 {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        each(key, *self);
    }
}

impl Numbers for u32 {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        // Rounds above 2^24, far outside every range of whole numbers.
        each(key, *self as f32);
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        if let Some(value) = self {
            value.numbers(key, each);
        }
    }
}

impl<T: Numbers> Numbers for [T] {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        for (index, value) in self.iter().enumerate() {
            value.numbers(&format!("{key}[{index}]"), each);
        }
    }
}

impl<T: Numbers, const COUNT: usize> Numbers for [T; COUNT] {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        self.as_slice().numbers(key, each);
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        self.as_slice().numbers(key, each);
    }
}

impl Numbers for Vec3 {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        self.to_array().numbers(key, each);
    }
}

impl Numbers for UVec3 {
    fn numbers(&self, key: &str, each: &mut dyn FnMut(&str, f32)) {
        self.to_array().numbers(key, each);
    }
}

/// The shortest text that reads back as the same number, with an exponent where there would be many zeros.
pub(crate) fn number_text(value: f32) -> String {
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-3..1e6).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// A vector as it is written in a file.
pub(super) fn vector_text(value: Vec3) -> String {
    let [x, y, z] = value.to_array().map(number_text);
    format!("[{x}, {y}, {z}]")
}

/// A number with its unit, which is left out for pure numbers.
pub(super) fn with_unit(text: &str, unit: &str) -> String {
    if unit == "1" { text.to_owned() } else { format!("{text} {unit}") }
}
