//! `sorb schema`: the JSON schema of scene files.

use crate::{error::CliError, output};

/// Prints the schema.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run() -> Result<(), CliError> {
    output::print(&sorb::scene::schema())
}
