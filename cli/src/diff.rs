//! `sorb diff`: where two saves differ first.

use std::path::PathBuf;

use crate::{error::CliError, output, run::read_save};

/// Arguments of `sorb diff`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A save
    first: PathBuf,
    /// Another save
    second: PathBuf,
}

/// Prints the column, the row and both values, or that the states are equal.
///
/// # Errors
/// A file is no save, or the states differ.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let (first, second) = (read_save(&arguments.first)?, read_save(&arguments.second)?);
    let scene = |save: &sorb::Save, path| save.scene().map_err(CliError::state(path));
    if scene(&first, &arguments.first)? != scene(&second, &arguments.second)? {
        return Err(CliError::CheckFailed("the saves are of two scenes".to_owned()));
    }
    match first.first_difference(&second) {
        None => output::print(&format!(
            "equal: {:.3} s, {} steps, digest {:016x}\n",
            first.time(),
            first.steps(),
            first.digest()
        )),
        Some(difference) => Err(CliError::CheckFailed(format!(
            "{difference}, the first at {:.6} s, the second at {:.6} s",
            first.time(),
            second.time()
        ))),
    }
}
