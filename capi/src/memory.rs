//! What callers hand over: pointers, texts, buffers and structs with their size. All use of their memory is here.

use std::{
    ffi::{CStr, c_char},
    mem::{MaybeUninit, size_of},
    ptr, slice,
};

use crate::failure::{Failure, Status};

/// A pointer that must not be null.
pub(crate) fn given<T>(pointer: Option<T>, name: &str) -> Result<T, Failure> {
    pointer.ok_or_else(|| null(name))
}

fn null(name: &str) -> Failure {
    Failure::new(Status::NullPointer, format!("`{name}` is NULL"))
}

/// The text of a caller.
///
/// # Safety
/// `text` is null or ends with a zero, and stays as it is for `'a`.
pub(crate) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(null(name));
    }
    // SAFETY: it is not null, the rest is the promise of the caller.
    let bytes = unsafe { CStr::from_ptr(text) };
    bytes.to_str().map_err(|error| Failure::new(Status::NotUtf8, format!("`{name}` is not UTF-8: {error}")))
}

/// Elements of a caller; the pointer may be null if there are none.
///
/// # Safety
/// `first` is null or points to `count` elements, which stay as they are for `'a`.
pub(crate) unsafe fn elements<'a, T>(first: *const T, count: usize, name: &str) -> Result<&'a [T], Failure> {
    check_count::<T>(count, name)?;
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(name)),
        // SAFETY: it is not null, the size fits an address, the rest is the promise of the caller.
        (false, _) => Ok(unsafe { slice::from_raw_parts(first, count) }),
    }
}

/// Numbers of a fixed count.
///
/// # Safety
/// `first` is null or points to `N` numbers.
pub(crate) unsafe fn numbers<const N: usize>(first: *const f32, name: &str) -> Result<[f32; N], Failure> {
    // SAFETY: the promise of the caller.
    let numbers = unsafe { elements(first, N, name) }?;
    numbers.try_into().map_err(|_| null(name))
}

/// Room for results of the same number as questions; nothing is written.
pub(crate) fn check_room<T>(first: *mut T, count: usize, name: &str) -> Result<(), Failure> {
    check_count::<T>(count, name)?;
    if count > 0 && first.is_null() { Err(null(name)) } else { Ok(()) }
}

/// No array is longer than half of all addresses.
fn check_count<T>(count: usize, name: &str) -> Result<(), Failure> {
    let most = isize::MAX as usize / size_of::<T>().max(1);
    if count <= most {
        return Ok(());
    }
    Err(Failure::new(Status::BadSize, format!("{count} elements of `{name}` are out of range 0 to {most}")))
}

/// Copies results.
///
/// # Safety
/// `first` is null, or has room for as many elements as `results`.
pub(crate) unsafe fn fill<T: Copy>(first: *mut T, results: &[T]) {
    if !first.is_null() {
        // SAFETY: the promise of the caller; what the library owns does not overlap it.
        unsafe { ptr::copy_nonoverlapping(results.as_ptr(), first, results.len()) };
    }
}

/// Copies bytes into a buffer of a caller, and tells their number. A null buffer asks for the number alone.
///
/// # Safety
/// `buffer` is null or has room for `capacity` bytes.
pub(crate) unsafe fn give(
    bytes: &[u8],
    (buffer, capacity): (*mut u8, usize),
    length: Option<&mut MaybeUninit<usize>>,
    name: &str,
) -> Result<(), Failure> {
    given(length, "length")?.write(bytes.len());
    if !buffer.is_null() && capacity < bytes.len() {
        let message = format!("`{name}` has {capacity} bytes, and needs {}", bytes.len());
        return Err(Failure::new(Status::BufferTooSmall, message));
    }
    // SAFETY: there is room, or it is null.
    unsafe { fill(buffer, bytes) };
    Ok(())
}

/// A struct whose first member is its size, so that later versions can add members at its end.
///
/// # Safety
/// It is `repr(C)`, begins with a `usize`, and any bits are a value of each of its members.
pub(crate) unsafe trait Versioned: Copy {
    /// Its name in C.
    const NAME: &'static str;
}

/// Declares structs of this kind by their names in C.
macro_rules! versioned {
    ($($Type:ident $name:literal,)+) => {
        $(
            const _: () = assert!(std::mem::offset_of!($Type, size) == 0);
            // SAFETY: `repr(C)`, begins with `size`, and has numbers and raw pointers only.
            unsafe impl crate::memory::Versioned for $Type {
                const NAME: &'static str = $name;
            }
        )+
    };
}
pub(crate) use versioned;

/// The size of a struct of a caller.
///
/// # Safety
/// `from` is null, or begins with a `usize`.
unsafe fn size_of_given<T: Versioned>(from: *const T) -> Result<usize, Failure> {
    if from.is_null() {
        return Err(null(T::NAME));
    }
    // SAFETY: it is not null, the rest is the promise of the caller.
    let size = unsafe { from.cast::<usize>().read() };
    let (least, most) = (size_of::<usize>(), size_of::<T>());
    if (least..=most).contains(&size) {
        return Ok(size);
    }
    let message =
        format!("{}.size = {size} is out of range {least} to {most}: set it to its sizeof", T::NAME);
    Err(Failure::new(Status::BadSize, message))
}

/// Reads a struct. What a caller of an earlier version does not have keeps its default.
///
/// # Safety
/// `from` is null, or points to as many bytes as its first member says.
pub(crate) unsafe fn read_sized<T: Versioned>(from: *const T, default: T) -> Result<T, Failure> {
    let mut value = default;
    // SAFETY: the promise of the caller; any bits are a value.
    unsafe {
        let size = size_of_given(from)?;
        ptr::copy_nonoverlapping(from.cast::<u8>(), (&raw mut value).cast::<u8>(), size);
    }
    Ok(value)
}

/// Refuses a struct that cannot be written, before anything is changed.
///
/// # Safety
/// `to` is null, or points to as many bytes as its first member says.
pub(crate) unsafe fn check_sized<T: Versioned>(to: *const T) -> Result<(), Failure> {
    // SAFETY: the promise of the caller.
    unsafe { size_of_given(to) }.map(|_| ())
}

/// Writes a struct but for its size: as much as the caller has room for.
///
/// # Safety
/// `to` is null, or points to as many bytes as its first member says.
pub(crate) unsafe fn write_sized<T: Versioned>(to: *mut T, value: &T) -> Result<(), Failure> {
    let skip = size_of::<usize>();
    // SAFETY: the promise of the caller; `size` is at least that of a `usize`, at most that of the struct.
    unsafe {
        let size = size_of_given(to)?;
        let from = ptr::from_ref(value).cast::<u8>().add(skip);
        ptr::copy_nonoverlapping(from, to.cast::<u8>().add(skip), size - skip);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    #[repr(C)]
    struct Pair {
        size: usize,
        first: u64,
        second: u64,
    }
    versioned! { Pair "pair", }

    #[test]
    fn structs_of_earlier_versions_have_fewer_members() {
        let default = Pair { size: 0, first: 1, second: 2 };
        let mut own = Pair { size: 16, first: 3, second: 4 };
        // SAFETY: `size` is at most that of the struct.
        let read = |own: &Pair| unsafe { read_sized(own, default) };
        assert_eq!(read(&own).expect("16 bytes"), Pair { size: 16, first: 3, second: 2 });
        // SAFETY: as above.
        unsafe { write_sized(&raw mut own, &Pair { size: 0, first: 7, second: 8 }) }.expect("16 bytes");
        assert_eq!(own, Pair { size: 16, first: 7, second: 4 });
        for size in [0, 7, 25, usize::MAX] {
            let error = read(&Pair { size, ..own }).map(|_| ()).expect_err("an impossible size");
            assert!(format!("{error:?}").contains("is out of range 8 to 24"), "{error:?}");
        }
    }
}
