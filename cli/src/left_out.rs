//! Subcommands of a program that was built without them.

use crate::error::CliError;

/// Whatever follows the subcommand.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    ignored: Vec<String>,
}

/// Says how to build the program with a subcommand, which has a feature.
fn refuse(lack: &str, [feature, subcommand]: [&str; 2], arguments: &Arguments) -> Result<(), CliError> {
    Err(CliError::Usage(format!(
        "this program was built without {lack}:\n\
         cargo run --release -p sorb-cli --features {feature} -- {subcommand} {}",
        arguments.ignored.join(" "),
    )))
}

/// `sorb validate`.
#[cfg(not(feature = "validation"))]
pub(crate) mod validate {
    pub(crate) use super::Arguments;
    use crate::error::CliError;

    /// # Errors
    /// Always [`CliError::Usage`].
    pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
        super::refuse("its references; this one has them", ["validation", "validate"], arguments)
    }
}

/// `sorb view`.
#[cfg(not(feature = "view"))]
pub(crate) mod view {
    pub(crate) use super::Arguments;
    use crate::error::CliError;

    /// # Errors
    /// Always [`CliError::Usage`].
    pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
        super::refuse("its window; this one has it", ["view", "view"], arguments)
    }
}
