//! Materials of sponges that change while a world runs.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sorb_kernels::{
    asleep::Asleep,
    column::{FAR_ROW, padded},
    columns::{Columns, lane},
    couple::interior::node_interior,
    params::Params,
};
use xxhash_rust::xxh3::xxh3_64;

use super::{StepError, World, sleep::Kind};
use crate::{
    clock::{Dormant, Steps},
    handle::SpongeHandle,
    rigid::{BodyKind, LightBodies},
    scene::{Body, Material, Scene},
    setup::params,
};

/// What commands have made of the scene that a world was built from, beside the present one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Origin {
    /// Digest of the first scene.
    pub(crate) first: u64,
    /// Digest of the present one.
    pub(crate) present: u64,
    /// How often every number of a body was taken before; numbers beyond the end never were.
    pub(crate) generations: Vec<u32>,
    /// Whether the engine can have dynamic bodies although the first scene had none.
    pub(crate) has_dynamics: bool,
    /// The bodies that the sponges were cut by, if they are not those of the present scene.
    #[serde(with = "crate::text")]
    pub(crate) cut_by: Option<Vec<Body>>,
    /// How often every number of a sponge was taken before.
    pub(crate) sponge_generations: Vec<u32>,
}

/// Digest of a scene.
pub(crate) fn digest_of(scene: &Scene) -> u64 {
    xxh3_64(format!("{scene:?}").as_bytes())
}

impl World {
    /// The material of a sponge as commands have left it; none if there is no such sponge.
    #[must_use]
    pub fn material(&self, sponge: SpongeHandle) -> Option<Material> {
        self.has_sponge(sponge).then(|| Material::from(&self.scene.sponges[sponge.index()]))
    }

    /// Digest of the scene that the world was built from.
    #[cfg(feature = "serde")]
    pub(crate) fn first_scene(&self) -> u64 {
        self.origin.as_ref().map_or_else(|| digest_of(&self.scene), |origin| origin.first)
    }

    /// What commands have made of the scene.
    pub(super) fn origin_mut(&mut self) -> &mut Origin {
        let scene = &self.scene;
        self.origin.get_or_insert_with(|| {
            let (first, is_dynamic) = (digest_of(scene), |body: &Body| body.kind == BodyKind::Dynamic);
            Origin {
                first,
                present: first,
                has_dynamics: scene.bodies.iter().any(is_dynamic),
                ..Origin::default()
            }
        })
    }

    /// Puts what commands have made of the scene in its place.
    pub(super) fn change_scene(&mut self, mut scene: Scene) {
        // By default they depend on the material. A world keeps those that it began with.
        let weights = self.scene.coupling_weights();
        if let Some(fluid) = &mut scene.fluid {
            fluid.coupling_weights.get_or_insert(weights);
        }
        self.origin_mut().present = digest_of(&scene);
        self.scene = Arc::new(scene);
        #[cfg(feature = "serde")]
        self.identity.take();
    }

    /// Gives a sponge another material.
    pub(super) fn set_material(&mut self, sponge: usize, material: &Material) -> Result<(), StepError> {
        let mut scene = Scene::clone(&self.scene);
        material.put(&mut scene.sponges[sponge]);
        self.change_scene(scene);
        let Params { step, gravity, .. } = self.params;
        let asleep = std::mem::take(&mut self.params.asleep);
        self.params = Params { step, gravity, asleep, ..params(&self.scene) };
        self.weigh_nodes(sponge);
        self.fit_wetness();
        self.fit_neighbourhood();
        self.light = LightBodies::new(&self.scene);
        self.light.set_gravity(gravity);
        self.steps_anew().map_err(|error| StepError::Scene(error.to_string()))?;
        self.wake_kinds(|kind| kind == Kind::Sponge(sponge) || kind == Kind::Fluid);
        self.apply_sleep();
        Ok(())
    }

    /// Masses of the nodes of a sponge, by its density.
    fn weigh_nodes(&mut self, sponge: usize) {
        let density = self.scene.sponges[sponge].density;
        let rows: Vec<usize> = self.node_rows(sponge).into_iter().flatten().collect();
        let nodes = &mut self.stores.host.nodes;
        for row in rows {
            let inverse_mass = &mut nodes.position[row][lane::nodes::position::INVERSE_MASS];
            if *inverse_mass > 0.0 {
                *inverse_mass = 1.0 / (density * nodes.volume[row]);
            }
        }
    }

    /// The wetness of nodes, if any material depends on it.
    pub(super) fn fit_wetness(&mut self) {
        let rows = padded(self.stores.host.rows.nodes);
        let has_wetting = self.params.solid.is_some() && self.params.has_wetting();
        let wetting = &mut self.stores.host.nodes.wetting;
        if has_wetting && wetting.is_empty() {
            *wetting = vec![[0.0; 4]; rows];
        } else if !has_wetting {
            wetting.clear();
        }
    }

    /// The neighbourhood of nodes at rest, which reaches as far as material swells.
    fn fit_neighbourhood(&mut self) {
        if self.scene.fluid.is_none() {
            return;
        }
        let rows = padded(self.stores.host.rows.nodes);
        let mut rest = Columns { rows: self.stores.host.rows, ..Columns::default() };
        rest.nodes.position.clone_from(&self.lattice.position);
        rest.nodes.position.resize(rows, FAR_ROW);
        rest.nodes.volume.clone_from(&self.lattice.node_volume);
        let (cpu, params) = (&self.cpu, Params { asleep: Asleep::default(), ..self.params.clone() });
        self.stores.host.nodes.interior = cpu.enter(|| node_interior(cpu, &params, &rest));
    }

    /// Bounds of the step, plans and placement for the present scene.
    pub(super) fn steps_anew(&mut self) -> Result<(), super::WorldError> {
        let bodies = &self.stores.host.bodies.states.0;
        self.steps = Steps::new(&self.scene, &self.params, bodies, self.engine.as_ref(), &Dormant::default());
        self.plan_anew()
    }
}
