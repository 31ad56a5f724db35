//! Standard output and standard error, for pipes that may close at any time.

use std::io::{self, ErrorKind, Write};

use crate::error::CliError;

/// Writes to standard output. It is no error if the reader has closed the pipe.
///
/// # Errors
/// [`CliError::Output`], for example on a full disk.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(error)),
        _ => Ok(()),
    }
}

/// Writes an error to standard error, each line after the first indented.
pub(crate) fn complain(message: &str) {
    let message = message.replace('\n', "\n       ");
    // Nothing can be reported if this fails.
    let _ = writeln!(io::stderr().lock(), "error: {message}");
}

/// Rows of text as aligned columns: `right` marks columns of numbers.
pub(crate) fn table<const N: usize>(rows: &[[String; N]], right: [bool; N]) -> String {
    let widths: [usize; N] = std::array::from_fn(|column| {
        let width = |row: &[String; N]| row[column].chars().count();
        rows.iter().map(width).max().unwrap_or(0)
    });
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for ((cell, width), right) in row.iter().zip(widths).zip(right) {
            let fill = " ".repeat(width - cell.chars().count());
            line += &if right { format!("  {fill}{cell}") } else { format!("  {cell}{fill}") };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}
