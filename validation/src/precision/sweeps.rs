//! Settings of the sweep: those that trade precision for time, without those that changed nothing.

/// The runs of a case.
pub(super) struct Sweep {
    pub(super) case: &'static str,
    /// Meaning of its error, in words.
    pub(super) error: &'static str,
    /// Prefixes of the names of the figures that count, and the scales of their errors.
    pub(super) figures: &'static [(&'static str, f64)],
    /// Solvers, resolutions, and changes of keys (joined by blanks) to try with them.
    pub(super) variants: &'static [(&'static str, &'static [f64], &'static [&'static str])],
}

impl Sweep {
    /// Solver, resolution and changes of all runs; the quick form has the two coarsest resolutions of every solver
    /// with two changes.
    pub(super) fn runs(&self, quick: bool) -> Vec<(&'static str, f64, &'static str)> {
        let (maximum_resolutions, maximum_changes) = if quick { (2, 2) } else { (usize::MAX, usize::MAX) };
        let mut runs: Vec<(&'static str, f64, &'static str)> = Vec::new();
        for (solver, resolutions, changes) in self.variants {
            if quick && runs.iter().any(|run| run.0 == *solver) {
                continue;
            }
            for resolution in resolutions.iter().take(maximum_resolutions) {
                for changes in changes.iter().take(maximum_changes) {
                    runs.push((*solver, *resolution, *changes));
                }
            }
        }
        runs
    }
}

/// The qualities; no change stands for the default keys.
const QUALITIES: &[&str] = &["", "quality=fast", "quality=accurate"];

/// Water in a sponge where runs are short: sweeps of the elastic solve, tolerance of the pressure solve, and support radius.
const POROUS: &[&str] = &[
    "",
    "quality=fast",
    "quality=accurate",
    "sponges[0].iterations=1",
    "fluid.density_tolerance=1e-2",
    "fluid.support=1.8",
];

/// What can make the solve for the divergence faster, one by one.
const FASTER: &[&str] = &[
    "time.courant=0.4",
    "time.maximum_step=0.008",
    "fluid.density_tolerance=1e-2",
    "fluid.density_tolerance=1e-4",
    "fluid.support=1.8",
];

/// All sweeps. Those of `dfsph`, the default before `divergence`, are the front that there was.
pub(super) const SWEEPS: &[Sweep] = &[
    Sweep {
        case: "hydrostatic",
        error: "pressure of the particles, L2 over that at the floor",
        figures: &[("pressure of particles", 1.0)],
        variants: &[
            ("divergence", &[0.5, 1.0], QUALITIES),
            ("divergence", &[1.0], FASTER),
            ("divergence", &[1.5], &[""]),
            ("dfsph", &[0.5, 1.0], QUALITIES),
            ("dfsph", &[1.5], &[""]),
            ("wcsph", &[0.5, 1.0], &["", "time.courant=0.4"]),
        ],
    },
    Sweep {
        case: "dam_break",
        error: "front and height at the wall against the film, root mean square over the way of the front and the first \
                height",
        figures: &[("front Z", 3.11), ("height at the wall", 1.0)],
        variants: &[
            ("divergence", &[0.5, 1.0, 1.5, 2.0], QUALITIES),
            ("divergence", &[1.0], FASTER),
            ("dfsph", &[0.5, 1.0, 1.5, 2.0], QUALITIES),
            ("wcsph", &[0.5, 1.0, 1.5], &["", "time.courant=0.4"]),
        ],
    },
    Sweep {
        case: "taylor_green",
        error: "decay of the energy and of the largest speed of a vortex, root mean square over both, with both amounts of \
                numerical viscosity",
        figures: &[("morris", 1.0)],
        variants: &[
            ("divergence", &[0.5, 0.7], &["", "quality=fast"]),
            ("dfsph", &[0.5, 0.7], &["", "quality=fast"]),
        ],
    },
    Sweep {
        case: "cantilever",
        error: "root mean square of two: nodes against converged elements on the same lattice (the solver), and sag of \
                the tip against Timoshenko (solver and lattice)",
        figures: &[("displacement against converged", 1.0), ("sag of the tip against Timoshenko", 1.0)],
        variants: &[
            ("vbd", &[0.5, 0.75], QUALITIES),
            ("vbd", &[1.0], &["", "quality=accurate", "sponges[0].iterations=1"]),
            ("vbd", &[0.5], &["time.maximum_step=0.0005"]),
            ("xpbd_neo_hookean", &[0.5], &[""]),
            ("sbd", &[0.5], &[""]),
        ],
    },
    Sweep {
        case: "permeameter",
        error: "permeability that the falling head shows, root mean square over three permeabilities",
        figures: &[("permeability for", 1.0)],
        variants: &[
            ("divergence+vbd", &[0.4], POROUS),
            ("divergence+vbd", &[0.6, 0.8], &["", "quality=fast"]),
            ("divergence+vbd", &[1.0], &[""]),
            ("dfsph+vbd", &[0.4, 0.6], &["", "quality=fast"]),
            ("dfsph+vbd", &[0.8], &[""]),
            ("wcsph+sbd", &[0.4], &[""]),
        ],
    },
    Sweep {
        case: "imbibition",
        error: "height of the front, L2 over the largest, root mean square over three permeabilities",
        figures: &[("front at", 1.0)],
        variants: &[
            ("divergence+vbd", &[1.0], POROUS),
            ("divergence+vbd", &[1.5, 2.0], &["", "quality=fast"]),
            ("dfsph+vbd", &[1.0, 1.5], &["", "quality=fast"]),
            ("wcsph+sbd", &[1.0], &[""]),
        ],
    },
    Sweep {
        case: "consolidation",
        error: "way down of the middle of the sponge, L2 over the largest, root mean square over two permeabilities",
        figures: &[("way down", 1.0)],
        variants: &[
            ("divergence+vbd", &[0.67], POROUS),
            ("divergence+vbd", &[1.0], &["", "quality=fast"]),
            ("dfsph+vbd", &[0.67], &["", "quality=fast"]),
            ("dfsph+vbd", &[1.0], &[""]),
        ],
    },
];
