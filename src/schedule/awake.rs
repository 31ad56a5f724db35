//! Reduced steps while parts of a scene sleep.

use sorb_kernels::{columns::Column, contents::Contents, step::Phase};

use super::plan::{Plan, PlanError};

/// The awake parts, as far as phases depend on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Awake {
    /// The fluid.
    pub(crate) fluid: bool,
    /// Any sponge.
    pub(crate) sponges: bool,
    /// Sponges that can touch each other or themselves.
    pub(crate) touch: bool,
}

impl Awake {
    /// Nothing sleeps.
    pub(crate) const EVERYTHING: Self = Self { fluid: true, sponges: true, touch: true };

    /// All that differ.
    pub(crate) const ALL: [Self; 6] = [
        Self::EVERYTHING,
        Self { fluid: true, sponges: true, touch: false },
        Self { fluid: true, sponges: false, touch: false },
        Self { fluid: false, sponges: true, touch: true },
        Self { fluid: false, sponges: true, touch: false },
        Self { fluid: false, sponges: false, touch: false },
    ];

    /// Index in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        Self::ALL.iter().position(|other| *other == self).unwrap_or(0)
    }

    /// The awake contents of a scene.
    pub(crate) fn of<'a>(self, all: &Contents<'a>) -> Contents<'a> {
        let mut awake = *all;
        if !self.fluid {
            awake.rows.fluid = 0;
        }
        if !self.sponges {
            awake.rows.nodes = 0;
        }
        awake.touch &= self.touch;
        awake
    }
}

/// The plans of a scene: of the whole step, and of the reduced steps while parts sleep, in the order of [`Awake::ALL`].
#[derive(Clone, Debug)]
pub(crate) struct Plans(pub(crate) Vec<Plan>);

impl Plans {
    /// Plans `step` for a scene, for every set of awake parts.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub(crate) fn new(
        step: &[Phase],
        contents: &Contents<'_>,
        observed: &[Column],
    ) -> Result<Self, PlanError> {
        let plan = |awake: Awake| Plan::new(step, &awake.of(contents), observed);
        Awake::ALL.into_iter().map(plan).collect::<Result<_, _>>().map(Self)
    }

    /// The plan of the whole step.
    pub(crate) fn whole(&self) -> &Plan {
        self.of(Awake::EVERYTHING)
    }

    /// The plan of a step with these awake parts.
    pub(crate) fn of(&self, awake: Awake) -> &Plan {
        &self.0[awake.index()]
    }
}
