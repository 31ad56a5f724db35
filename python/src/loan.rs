//! Columns that are lent to `NumPy` without a copy. While one is lent, nothing may change the world.

use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

use pyo3::{exceptions::PyBufferError, prelude::*, types::PyDict};

use crate::world::World;

/// Number of loans of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loans(Arc<AtomicUsize>);

impl Loans {
    /// Refuses a change while there are any.
    pub(crate) fn check(&self) -> PyResult<()> {
        match self.0.load(Ordering::Acquire) {
            0 => Ok(()),
            count => Err(PyBufferError::new_err(format!(
                "{count} arrays of this world are still in use, and it cannot change below them: delete them (`del`), or keep copies \
                 (`.copy()`)"
            ))),
        }
    }
}

/// Rows of a column in the memory of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    address: usize,
    rows: usize,
    /// Elements of a row; 0 for a column of single numbers.
    components: usize,
    stride: usize,
    kind: &'static str,
}

impl Rows {
    /// Rows of three floats, beside a fourth that is internal.
    pub(crate) fn vectors(rows: &[[f32; 4]]) -> Self {
        Self { address: rows.as_ptr().addr(), rows: rows.len(), components: 3, stride: 16, kind: "f4" }
    }

    /// Floats.
    pub(crate) fn floats(rows: &[f32]) -> Self {
        Self { address: rows.as_ptr().addr(), rows: rows.len(), components: 0, stride: 4, kind: "f4" }
    }

    /// Integers.
    pub(crate) fn integers(rows: &[u32]) -> Self {
        Self { address: rows.as_ptr().addr(), rows: rows.len(), components: 0, stride: 4, kind: "u4" }
    }

    /// Rows of three integers.
    pub(crate) fn triples(rows: &[[u32; 3]]) -> Self {
        Self { address: rows.as_ptr().addr(), rows: rows.len(), components: 3, stride: 12, kind: "u4" }
    }
}

/// A column that is lent. Arrays that `NumPy` makes of it keep it, and it keeps the world.
#[pyclass(frozen)]
#[derive(Debug)]
pub(crate) struct Loan {
    rows: Rows,
    loans: Loans,
    _world: Py<World>,
}

impl Loan {
    pub(crate) fn new(rows: Rows, loans: &Loans, world: Py<World>) -> Self {
        loans.0.fetch_add(1, Ordering::AcqRel);
        Self { rows, loans: loans.clone(), _world: world }
    }
}

impl Drop for Loan {
    fn drop(&mut self) {
        self.loans.0.fetch_sub(1, Ordering::AcqRel);
    }
}

#[pymethods]
impl Loan {
    /// How `NumPy` reads it, version 3 of the protocol: read only.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Rows { address, rows, components, stride, kind } = self.rows;
        let order = if cfg!(target_endian = "little") { '<' } else { '>' };
        let (shape, strides) = if components == 0 {
            (vec![rows], vec![stride])
        } else {
            (vec![rows, components], vec![stride, 4])
        };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", format!("{order}{kind}"))?;
        interface.set_item("shape", pyo3::types::PyTuple::new(py, shape)?)?;
        interface.set_item("strides", pyo3::types::PyTuple::new(py, strides)?)?;
        interface.set_item("data", (address, true))?;
        Ok(interface)
    }
}
