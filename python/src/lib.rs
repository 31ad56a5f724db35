//! What Python has of sorb: plain numbers, texts and bytes, out of which the package in `package/sorb` makes arrays and exceptions.
//!
//! Nothing here is safe to rely on but that package. The interpreter lock is released while anything takes time.

mod error;
mod loan;
mod scene;
mod state;
mod world;

use pyo3::prelude::*;

#[pymodule]
mod _sorb {
    #[pymodule_export]
    use super::loan::Loan;
    #[pymodule_export]
    use super::scene::{presets, read_scene};
    #[pymodule_export]
    use super::state::{Snapshot, verify, write_png};
    #[pymodule_export]
    use super::world::World;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
