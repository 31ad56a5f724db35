//! The text of a panic, for the page: WebAssembly has no standard error.

use std::{
    panic,
    sync::{Mutex, Once, PoisonError},
};

static MESSAGE: Mutex<String> = Mutex::new(String::new());
static ONCE: Once = Once::new();

/// Keeps the text of the next panic.
pub(crate) fn keep_message() {
    ONCE.call_once(|| {
        panic::set_hook(Box::new(|panic| {
            *MESSAGE.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string();
        }));
    });
}

/// Address and length of the text.
pub(crate) fn message() -> (*const u8, usize) {
    let message = MESSAGE.lock().unwrap_or_else(PoisonError::into_inner);
    (message.as_ptr(), message.len())
}
