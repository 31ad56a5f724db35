//! Properties of kernels that a device depends on, derived from the declarations.

use crate::{columns::Column, kernel::Kernel};

impl Kernel {
    /// Whether it sorts the particles into the order of this step: it writes the cells.
    #[must_use]
    pub fn sorts_fluid(&self) -> bool {
        self.writes.contains(&Column::FluidCells)
    }

    /// Whether it reads the cells of the particles, which are not transferred.
    #[must_use]
    pub fn searches_fluid(&self) -> bool {
        self.reads.contains(&Column::FluidCells)
    }

    /// Whether the twin writes the particles back to the buffers that the next step sorts, with their identities.
    #[must_use]
    pub fn returns_fluid(&self) -> bool {
        self.twin_access.writes.contains(&Column::FluidId)
    }

    /// Whether it overwrites a column without reading it.
    pub(super) fn renews(&self, column: Column) -> bool {
        self.writes.contains(&column) && !self.reads.contains(&column)
    }

    /// Whether the twin of the kernel before it writes all columns of this one.
    pub(super) fn is_done_by(&self, before: &Self) -> bool {
        self.writes.iter().all(|column| before.twin_access.writes.contains(column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KERNELS;

    /// Names of the kernels with a property.
    fn names(holds: impl Fn(&Kernel) -> bool) -> Vec<&'static str> {
        KERNELS.iter().filter(|kernel| holds(kernel)).map(|kernel| kernel.name).collect()
    }

    #[test]
    fn properties_are_those_of_the_intended_kernels() {
        assert_eq!(names(Kernel::sorts_fluid), ["grid::sort_fluid"]);
        let searches = ["grid::fluid_neighbors", "divergence::images", "couple::controls"];
        assert_eq!(names(Kernel::searches_fluid), searches);
        assert_eq!(names(Kernel::returns_fluid), ["sph::advect"]);
        assert_eq!(names(|kernel| kernel.renews(Column::FluidExtremes)), ["sph::kick"]);
        assert_eq!(names(|kernel| kernel.renews(Column::NodeExtremes)), ["pbd::velocity"]);
        let pairs = KERNELS.iter().map(|before| names(|kernel| kernel.is_done_by(before)));
        assert_eq!(pairs.flatten().collect::<Vec<_>>(), ["sph::density"]);
    }
}
