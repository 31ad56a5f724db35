//! Status codes, the text of the last failure, and the end of every panic.

use std::{
    any::Any,
    cell::RefCell,
    ffi::{CStr, CString, c_char},
    panic::{AssertUnwindSafe, catch_unwind},
};

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// It did what it says.
    Ok = 0,
    /// A pointer is NULL that must not be.
    NullPointer = 1,
    /// A text is not UTF-8.
    NotUtf8 = 2,
    /// The `size` of a struct, or a length, is impossible.
    BadSize = 3,
    /// The buffer is too small; the length that it needs was given back.
    BufferTooSmall = 4,
    /// A number or a name is none of those that there are.
    NoSuchThing = 5,
    /// A scene cannot be read, changed or used.
    Scene = 6,
    /// A world cannot be built: its scene, threads, SIMD level or backend.
    World = 7,
    /// A step failed. The world takes no further ones.
    Step = 8,
    /// A command is out of range, or of something that does not exist.
    Command = 9,
    /// A question is out of range.
    Query = 10,
    /// A save is not usable, or cannot be made.
    State = 11,
    /// A recording is not usable, does not fit the call, or was not played to the same digests.
    Recording = 12,
    /// A defect of the library. The world that was changed meanwhile is refused from then on.
    Panic = 13,
}

/// Why a call failed.
#[derive(Debug)]
pub(crate) struct Failure {
    status: Status,
    message: String,
}

impl Failure {
    pub(crate) fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// Of an error of the library.
    pub(crate) fn of(status: Status) -> impl FnOnce(&dyn std::error::Error) -> Self {
        move |error| Self::new(status, error.to_string())
    }

    fn of_panic(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
        Self::new(Status::Panic, format!("a defect of sorb: {}", text.unwrap_or("a panic without a text")))
    }
}

/// A result whose error is of the library.
pub(crate) trait Fails<T> {
    /// Adds the status.
    fn fails(self, status: Status) -> Result<T, Failure>;
}

impl<T, E: std::error::Error> Fails<T> for Result<T, E> {
    fn fails(self, status: Status) -> Result<T, Failure> {
        self.map_err(|error| Failure::of(status)(&error))
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Runs the body of an entry: no panic leaves it, and the text of a failure is kept.
pub(crate) fn entry(body: impl FnOnce() -> Result<(), Failure>) -> Status {
    let result = catch_unwind(AssertUnwindSafe(body));
    let failure = match result {
        Ok(Ok(())) => return Status::Ok,
        Ok(Err(failure)) => failure,
        Err(payload) => Failure::of_panic(&*payload),
    };
    // A zero ends a text in C.
    let text = CString::new(failure.message.replace('\0', "\u{fffd}")).unwrap_or_default();
    // While a thread ends there is no place for its text any more.
    let _ = LAST.try_with(|last| last.replace(text));
    failure.status
}

/// Text of the last failure of this thread, which names key, value and range; empty before the first. Never NULL. Valid until the next
/// call of this thread that fails, and until the thread ends.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Name of a status, such as "buffer too small"; "unknown status" for other numbers. Never NULL, valid for ever.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_status_name(status: i32) -> *const c_char {
    const NAMES: [&CStr; 14] = [
        c"ok",
        c"null pointer",
        c"not UTF-8",
        c"bad size",
        c"buffer too small",
        c"no such thing",
        c"scene",
        c"world",
        c"step",
        c"command",
        c"query",
        c"state",
        c"recording",
        c"panic",
    ];
    let name = usize::try_from(status).ok().and_then(|status| NAMES.get(status).copied());
    name.unwrap_or(c"unknown status").as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last() -> String {
        // SAFETY: never null, and ends with a zero.
        unsafe { CStr::from_ptr(sorb_last_error()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn a_panic_becomes_a_status_and_its_text_is_kept_by_thread() {
        assert_eq!(last(), "");
        assert_eq!(entry(|| panic!("planted {}", 1)), Status::Panic);
        assert_eq!(last(), "a defect of sorb: planted 1");
        assert_eq!(entry(|| panic!("planted")), Status::Panic);
        assert_eq!(last(), "a defect of sorb: planted");
        assert_eq!(entry(|| std::panic::panic_any(1_u8)), Status::Panic);
        assert_eq!(last(), "a defect of sorb: a panic without a text");
        let other = std::thread::spawn(last).join();
        assert_eq!(other.ok().as_deref(), Some(""));
        assert_eq!(entry(|| Err(Failure::new(Status::Query, "a\0b"))), Status::Query);
        assert_eq!(last(), "a\u{fffd}b");
        // A success leaves it.
        assert_eq!(entry(|| Ok(())), Status::Ok);
        assert_eq!(last(), "a\u{fffd}b");
    }

    #[test]
    fn every_status_has_a_name() {
        // SAFETY: never null, and ends with a zero.
        let name = |status: i32| unsafe { CStr::from_ptr(sorb_status_name(status)) };
        assert_eq!(name(Status::Panic as i32), c"panic");
        assert_eq!(name(Status::BufferTooSmall as i32), c"buffer too small");
        assert_eq!(name(-1), c"unknown status");
        assert_eq!(name(14), c"unknown status");
    }
}
