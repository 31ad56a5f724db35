//! sorb in a web page: exports for JavaScript, without bindings.
//!
//! One world at a time. JavaScript asks for [`room`], writes its input there (UTF-8 text or the bytes of a file) and calls a function.
//! Functions that can fail return 0, or 1 with a text. [`answer`] points to that text, or to the result: JSON or the bytes of a file.
//! A pointer leads into the memory of the module, and is valid until the next call: memory that grows detaches its buffer.
//!
//! A panic ends the module. [`panic_message`] has its text.

#![allow(unsafe_code, reason = "exports keep their names; a player borrows its recording")]

mod ask;
mod columns;
mod page;
mod panics;
mod replay;
mod report;

use std::cell::RefCell;

use page::{Failure, Page};

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

/// Acts on the page.
fn with<R>(act: impl FnOnce(&mut Page) -> R) -> R {
    PAGE.with_borrow_mut(act)
}

/// Acts on the page, and keeps the answer or the text of the failure. 0, or 1 with a text.
fn answered(act: impl FnOnce(&mut Page) -> Result<Vec<u8>, Failure>) -> u32 {
    with(|page| {
        let result = act(page);
        let status = u32::from(result.is_err());
        page.answer = result.unwrap_or_else(|failure| failure.to_string().into_bytes());
        status
    })
}

/// Room for `length` bytes of input.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *const u8 {
    panics::keep_message();
    with(|page| {
        page.input.clear();
        page.input.resize(length, 0);
        page.input.as_ptr()
    })
}

/// The bytes of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    with(|page| page.answer.as_ptr())
}

/// Their number.
#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    with(|page| page.answer.len())
}

/// The text of a panic.
#[unsafe(no_mangle)]
pub extern "C" fn panic_message() -> *const u8 {
    panics::message().0
}

/// Its number of bytes.
#[unsafe(no_mangle)]
pub extern "C" fn panic_length() -> usize {
    panics::message().1
}

/// Answers with the scenes of the library: `[{"name", "title", "text"}]`.
#[unsafe(no_mangle)]
pub extern "C" fn presets() -> u32 {
    answered(|_| page::presets())
}

/// Answers with the JSON schema of scenes: keys with their range, unit and description.
#[unsafe(no_mangle)]
pub extern "C" fn schema() -> u32 {
    answered(|_| page::schema())
}

/// Builds a world. Input: `{"scene": NAME or TOML, "resolution": 1, "set": ["fluid.viscosity=1e-5"], "simd": "fallback"}`, the last three
/// optional.
#[unsafe(no_mangle)]
pub extern "C" fn load() -> u32 {
    answered(Page::load)
}

/// Answers with what does not change from step to step: scene, shapes of the bodies, materials, SIMD level.
#[unsafe(no_mangle)]
pub extern "C" fn describe() -> u32 {
    answered(|page| report::describe(page.world()?))
}

/// Takes a step.
#[unsafe(no_mangle)]
pub extern "C" fn step() -> u32 {
    answered(Page::step)
}

/// Takes the steps of a frame. While a recording plays, compares it with its digest.
#[unsafe(no_mangle)]
pub extern "C" fn frame() -> u32 {
    answered(Page::frame)
}

/// Answers with the clock, the counts and the digest.
#[unsafe(no_mangle)]
pub extern "C" fn status() -> u32 {
    answered(|page| report::status(page))
}

/// The digest of the state; 0 without a world.
#[unsafe(no_mangle)]
pub extern "C" fn digest() -> u64 {
    with(|page| page.world().map_or(0, sorb::World::digest))
}

/// Pushes a command. Input: the command as JSON, as in files of `sorb record --commands`.
#[unsafe(no_mangle)]
pub extern "C" fn command() -> u32 {
    answered(Page::command)
}

/// Answers with what a ray meets first, or `null`. Input: `{"origin": [0, 1, 0], "direction": [0, -1, 0], "water": true}`.
#[unsafe(no_mangle)]
pub extern "C" fn cast() -> u32 {
    answered(|page| ask::cast(page.world()?, &page.input))
}

/// Answers with the state as a file that `sorb run --from` reads.
#[unsafe(no_mangle)]
pub extern "C" fn save() -> u32 {
    answered(|page| page::save(page.world()?))
}

/// Builds the world of a save. Input: the bytes of the file.
#[unsafe(no_mangle)]
pub extern "C" fn restore() -> u32 {
    answered(Page::restore)
}

/// Begins a recording with the present state. `every` is the number of frames from a key frame to the next; 0: none.
#[unsafe(no_mangle)]
pub extern "C" fn record(every: u32) -> u32 {
    answered(|page| page.record(every))
}

/// Ends the recording. Answers with a file that `sorb replay` plays.
#[unsafe(no_mangle)]
pub extern "C" fn end_recording() -> u32 {
    answered(Page::end_recording)
}

/// Plays a recording from its beginning: [`frame`] plays the next frame of it. Input: the bytes of the file.
#[unsafe(no_mangle)]
pub extern "C" fn play() -> u32 {
    answered(Page::play)
}

/// Plays the recording to its end, and compares every frame. Answers with the number of frames. Input: the bytes of the file.
#[unsafe(no_mangle)]
pub extern "C" fn verify() -> u32 {
    answered(|page| replay::verify(&page.input))
}

/// The first number of a column, by its number in `COLUMNS` of `columns.rs`; null without a world.
#[unsafe(no_mangle)]
pub extern "C" fn column(number: u32) -> *const u8 {
    with(|page| page.column(number).as_ptr())
}

/// The bytes of that column.
#[unsafe(no_mangle)]
pub extern "C" fn column_length(number: u32) -> usize {
    with(|page| page.column(number).len())
}
