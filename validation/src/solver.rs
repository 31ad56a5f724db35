//! The available solvers, and scenes that use them.

use std::sync::LazyLock;

use serde_json::Value;
use sorb::scene::{FluidSolver, Scene, SceneError, schema};

use crate::case::Subject;

/// What a solver computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverKind {
    /// `fluid.solver`.
    Water,
    /// `sponges[].solver`.
    Sponge,
}

/// The solvers of a run; none stands for the default of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Solvers {
    /// Value of `fluid.solver`.
    pub water: Option<String>,
    /// Value of `sponges[].solver`.
    pub sponge: Option<String>,
}

/// Values of `fluid.solver` and `sponges[].solver` in the schema of scenes; empty for a key that the schema lacks.
static CHOICES: LazyLock<[Vec<String>; 2]> = LazyLock::new(|| {
    let schema: Value = serde_json::from_str(&schema()).unwrap_or_default();
    ["Fluid", "Sponge"].map(|table| choices(&schema, &schema["$defs"][table]["properties"]["solver"]))
});

/// The default of a sponge.
static DEFAULT_OF_SPONGES: LazyLock<Option<String>> = LazyLock::new(|| {
    let schema: Value = serde_json::from_str(&schema()).unwrap_or_default();
    schema["$defs"]["Sponge"]["properties"]["solver"]["default"].as_str().map(str::to_owned)
});

/// All texts that a node of a schema allows, through references.
fn choices(schema: &Value, node: &Value) -> Vec<String> {
    match node {
        Value::Object(members) => members
            .iter()
            .flat_map(|(key, value)| match (key.as_str(), value) {
                ("const", Value::String(text)) => vec![text.clone()],
                ("enum", Value::Array(texts)) => {
                    texts.iter().filter_map(Value::as_str).map(str::to_owned).collect()
                }
                ("$ref", Value::String(place)) => {
                    let target = schema.pointer(place.trim_start_matches('#'));
                    target.map_or_else(Vec::new, |target| choices(schema, target))
                }
                ("oneOf" | "anyOf" | "allOf", Value::Array(parts)) => {
                    parts.iter().flat_map(|part| choices(schema, part)).collect()
                }
                _ => Vec::new(),
            })
            .collect(),
        _ => Vec::new(),
    }
}

impl SolverKind {
    /// Names of the solvers, as in scene files.
    ///
    /// A simulator without such a key has one solver, under the name of the paper's.
    #[must_use]
    pub fn names(self) -> Vec<String> {
        let (index, only) = match self {
            Self::Water => (0, "wcsph"),
            Self::Sponge => (1, "sbd"),
        };
        if CHOICES[index].is_empty() { vec![only.to_owned()] } else { CHOICES[index].clone() }
    }

    /// The solver of scenes without the key; sponges that are coupled as in the paper have water of their own.
    #[must_use]
    pub fn default_name(self) -> String {
        match self {
            Self::Water => {
                let name = serde_json::to_value(FluidSolver::default()).unwrap_or_default();
                name.as_str().unwrap_or("wcsph").to_owned()
            }
            Self::Sponge => DEFAULT_OF_SPONGES.clone().unwrap_or_else(|| "sbd".to_owned()),
        }
    }

    fn has_key(self) -> bool {
        !CHOICES[match self {
            Self::Water => 0,
            Self::Sponge => 1,
        }]
        .is_empty()
    }
}

impl Solvers {
    /// The scene with these solvers.
    ///
    /// # Errors
    /// The scene refuses them.
    pub fn applied(&self, scene: &Scene) -> Result<Scene, SceneError> {
        let mut changes = Vec::new();
        if let (Some(name), true, Some(_)) = (&self.water, SolverKind::Water.has_key(), &scene.fluid) {
            changes.push(format!("fluid.solver=\"{name}\""));
        }
        if let (Some(name), true) = (&self.sponge, SolverKind::Sponge.has_key()) {
            changes
                .extend((0..scene.sponges.len()).map(|index| format!("sponges[{index}].solver=\"{name}\"")));
        }
        if changes.is_empty() {
            Ok(scene.clone())
        } else {
            scene.with_overrides(changes.iter().map(String::as_str))
        }
    }

    /// Name of the solver of the sponge.
    #[must_use]
    pub fn sponge_name(&self) -> String {
        self.sponge.clone().unwrap_or_else(|| SolverKind::Sponge.default_name())
    }

    /// Whether the sponge is solved by the strain constraints of the paper.
    #[must_use]
    pub fn is_strain_based(&self) -> bool {
        self.sponge_name() == "sbd"
    }

    /// Names of the solvers that matter to a case, for tables.
    #[must_use]
    pub fn label(&self, subject: Subject) -> String {
        let name =
            |chosen: &Option<String>, kind: SolverKind| chosen.clone().unwrap_or_else(|| kind.default_name());
        let water = || name(&self.water, SolverKind::Water);
        let sponge = || name(&self.sponge, SolverKind::Sponge);
        match subject {
            Subject::Water => water(),
            Subject::Sponge => sponge(),
            Subject::Coupling if self.water.is_none() && sponge() != "vbd" => format!("dfsph+{}", sponge()),
            Subject::Coupling => format!("{}+{}", water(), sponge()),
        }
    }
}

/// An isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio, -1 to 0.5 \[1\].
    pub poisson: f64,
    /// Mass over volume, pores included \[kg/m^3\].
    pub density: f64,
}

impl Material {
    /// Shear modulus mu and first Lame parameter lambda \[Pa\].
    #[must_use]
    pub fn lame(&self) -> (f64, f64) {
        let shear = self.young / (2.0 * (1.0 + self.poisson));
        let first = self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        (shear, first)
    }

    /// Modulus of compression between rigid walls, `lambda + 2 mu` \[Pa\].
    #[must_use]
    pub fn confined(&self) -> f64 {
        let (shear, first) = self.lame();
        first + 2.0 * shear
    }

    /// Gives all sponges of a scene this material.
    ///
    /// The strain constraints of the paper have no Poisson's ratio. In the limit of small strain their energy is
    /// `M_s / 2 sum e_kk^2 + 2 M_t sum e_kl^2 + M_v / 2 (tr e)^2` with the moduli of stretch, shear and volume. It is
    /// isotropic for `M_s = 2 mu`, `M_t = mu`, `M_v = lambda`.
    ///
    /// # Errors
    /// The scene refuses it.
    pub fn applied(&self, scene: &Scene, solvers: &Solvers) -> Result<Scene, SceneError> {
        let (shear, first) = self.lame();
        let mut changes = Vec::new();
        for index in 0..scene.sponges.len() {
            let mut set = |key: &str, value: f64| changes.push(format!("sponges[{index}].{key}={value:e}"));
            set("density", self.density);
            if solvers.is_strain_based() {
                set("stretch_modulus", 2.0 * shear);
                set("shear_modulus", shear);
                set("volume_modulus", first.max(10.0));
            } else {
                set("young_modulus", self.young);
                set("poisson_ratio", self.poisson);
            }
        }
        scene.with_overrides(changes.iter().map(String::as_str))
    }
}
