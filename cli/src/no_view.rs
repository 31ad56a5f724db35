//! `sorb view` in a program without it.

use crate::error::CliError;

/// Whatever follows `sorb view`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    ignored: Vec<String>,
}

/// Says how to build the program with the window.
///
/// # Errors
/// Always [`CliError::Usage`].
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    Err(CliError::Usage(format!(
        "this program was built without its window; this one has it:\n\
         cargo run --release -p sorb-cli --features view -- view {}",
        arguments.ignored.join(" "),
    )))
}
