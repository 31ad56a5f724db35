//! Sponges that come and go while a world runs.
//!
//! A sponge has a number, by which nodes, parameters and the scene know it. What is removed leaves a sponge without nodes behind, until
//! another one takes its number. The rows of nodes are those of a world of the new scene; what others have in their rows moves with them.

use std::sync::Arc;

use glam::Vec3;
use sorb_kernels::{
    columns::{Columns, Store},
    params::Params,
};

use super::{StepError, World, WorldError, fastest, placing::bounds, sleep, slots::Slots};
use crate::{
    command::Command,
    handle::SpongeHandle,
    rigid::LightBodies,
    scene::{BlockShape, Scene, Sponge},
    setup::{TOUCH, node_columns, params, pores, sponge_lattice},
    sponge::{Lattice, Skin, VERTEX_COLORS},
    state::{append_column, saved_columns, take_column},
    water::{APART, Points, Room},
};

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

impl World {
    /// The sponges that are there, in the order of their numbers.
    pub fn sponge_handles(&self) -> impl Iterator<Item = SpongeHandle> {
        let all = (0..self.scene.sponges.len()).map(|index| self.sponge_handle_of(index));
        all.filter(|sponge| !self.scene.sponges[sponge.index()].is_removed())
    }

    /// The handle of the next sponge that a command adds, after those that wait.
    #[must_use]
    pub fn next_sponge(&self) -> SpongeHandle {
        let (index, generation) = self.sponge_slots_after_commands().next();
        SpongeHandle::new(index, generation)
    }

    /// The surface of the mesh that a sponge was made of, which follows it. None for a sponge of another shape, and for a stale handle.
    #[must_use]
    pub fn skin(&self, sponge: SpongeHandle) -> Option<&Skin> {
        self.has_sponge(sponge).then(|| self.skins().get(sponge.index())?.as_ref()).flatten()
    }

    /// The skins of all sponges, by number.
    pub(crate) fn skins(&self) -> &[Option<Skin>] {
        self.skins.get_or_init(|| {
            let all = self.scene.sponges.iter().enumerate();
            all.map(|(index, sponge)| self.skin_of(index, sponge)).collect()
        })
    }

    fn skin_of(&self, index: usize, sponge: &Sponge) -> Option<Skin> {
        let BlockShape::Mesh { mesh } = &sponge.shape else { return None };
        let (block, tets) = ((sponge.position, sponge.size()), self.tets_of(index));
        Some(Skin::new(mesh.solid().ok()?, block, (&self.lattice.position, &tets), sponge.edge))
    }

    /// The handle of the sponge with a number.
    pub(crate) fn sponge_handle_of(&self, index: usize) -> SpongeHandle {
        let generations = self.origin.as_ref().map_or(&[][..], |origin| &origin.sponge_generations);
        SpongeHandle::new(index as u32, generations.get(index).copied().unwrap_or(0))
    }

    /// The numbers of sponges.
    pub(crate) fn sponge_slots(&self) -> Slots<()> {
        let slot = |(index, sponge): (usize, &Sponge)| {
            (self.sponge_handle_of(index).generation(), (!sponge.is_removed()).then_some(()))
        };
        Slots::new(self.scene.sponges.iter().enumerate().map(slot))
    }

    /// The same after the commands that wait.
    pub(crate) fn sponge_slots_after_commands(&self) -> Slots<()> {
        let mut slots = self.sponge_slots();
        for command in &self.commands.pending {
            match command {
                Command::AddSponge { sponge, .. } => slots.take(sponge.index(), sponge.generation(), ()),
                Command::RemoveSponge { sponge } => slots.free(sponge.index(), sponge.generation()),
                _ => {}
            }
        }
        slots
    }

    /// Whether a sponge is there.
    pub(crate) fn has_sponge(&self, sponge: SpongeHandle) -> bool {
        self.sponge_slots().of(sponge.index(), sponge.generation()).is_some()
    }

    /// Whether commands that wait change the rows of nodes.
    pub(crate) fn has_node_commands(&self) -> bool {
        let changes =
            |command: &Command| matches!(command, Command::AddSponge { .. } | Command::RemoveSponge { .. });
        self.commands.pending.iter().any(changes)
    }

    /// The scene with a sponge in place of the one with a number, or after the last.
    pub(crate) fn scene_with_sponge(&self, index: usize, sponge: Sponge) -> Scene {
        let sponge = Sponge { added: true, ..sponge };
        let mut scene = Scene::clone(&self.scene);
        match scene.sponges.get_mut(index) {
            Some(own) => *own = sponge,
            None => scene.sponges.push(sponge),
        }
        scene
    }

    /// Why there is no room for a sponge; none if there is.
    pub(crate) fn sponge_refusal(&self, description: &Sponge) -> Option<String> {
        let lattice = match sponge_lattice(description) {
            Ok(lattice) => lattice,
            Err(error) => return Some(error.to_string()),
        };
        let places: Vec<Vec3> = lattice.position.iter().map(place).collect();
        let (edge, own) = (description.edge, bounds(places.iter().copied()));
        let in_body = |body: &crate::rigid::Body| {
            body.touches_nodes && places.iter().any(|point| body.distance(*point) < -TOUCH * edge)
        };
        if let Some(body) = self.bodies().iter().position(in_body) {
            return Some(format!("body number {body} is there, `{}`", self.scene.bodies[body].name));
        }
        if let Some(other) = self.sponge_at(None, &places, (&lattice.position, &lattice.tets), own) {
            return Some(format!("sponge number {other} is there, `{}`", self.scene.sponges[other].name));
        }
        if self.is_claimed((own.0 - edge, own.1 + edge)) {
            return Some("a command that waits brings something there; take a step first".to_owned());
        }
        let wet = self.water_in_pores(description);
        (wet > 0).then(|| format!("{wet} of the particles in its pores would be in other water"))
    }

    /// The water that a sponge brings along in its pores \[m\].
    fn pores_of(&self, description: &Sponge) -> Vec<Vec3> {
        if self.scene.fluid.is_none() {
            return Vec::new();
        }
        pores(&self.scene, description, &self.params, self.bodies()).unwrap_or_default()
    }

    /// Particles in the pores of a sponge that would be in other water.
    fn water_in_pores(&self, description: &Sponge) -> usize {
        let own = self.pores_of(description);
        let distance = APART * self.params.fluid.spacing;
        let (low, high) = bounds(own.iter().copied());
        let mut near = Points::new(distance);
        for point in self.particle_positions().iter().map(place) {
            if point.cmpge(low - distance).all() && point.cmple(high + distance).all() {
                near.insert(point);
            }
        }
        own.iter().filter(|point| near.is_near(**point)).count()
    }

    /// Adds a sponge with the handle that was promised.
    pub(super) fn add_sponge(&mut self, sponge: SpongeHandle, description: &Sponge) -> Result<(), StepError> {
        // Only a state that was made up has another one.
        if self.sponge_slots().next() != (sponge.index() as u32, sponge.generation()) {
            return Ok(());
        }
        let water = self.pores_of(description);
        self.put_sponge(sponge.index(), description.clone())?;
        for body in self.body_handles().collect::<Vec<_>>() {
            if self.scene.bodies[body.index()].grip {
                self.hold_what_is_inside(body.index(), Some(sponge.index() as u32));
            }
        }
        self.add_water(&Room::of(water), |_| description.velocity)
    }

    /// Removes a sponge. The water in it stays where it is.
    pub(super) fn remove_sponge(&mut self, sponge: SpongeHandle) -> Result<(), StepError> {
        let index = sponge.index();
        self.put_sponge(index, Sponge::removed(index, &self.scene.sponges[index]))?;
        let generations = &mut self.origin_mut().sponge_generations;
        generations.resize(generations.len().max(index + 1), 0);
        generations[index] = sponge.generation().saturating_add(1);
        Ok(())
    }

    /// Puts a sponge in place of the one with a number, or after the last.
    fn put_sponge(&mut self, index: usize, sponge: Sponge) -> Result<(), StepError> {
        let fail = |error: WorldError| StepError::Scene(error.to_string());
        self.keep_cutters();
        let scene = self.scene_with_sponge(index, sponge);
        self.change_scene(scene);
        let Params { step, gravity, .. } = self.params;
        self.params = Params { step, gravity, ..params(&self.scene) };
        let origin = self.origin_mut().clone();
        let (lattice, mut columns) =
            node_columns(&self.scene, &self.params, &self.cpu, &origin).map_err(fail)?;
        carry_rows((&self.stores.host, &self.lattice), (&mut columns, &lattice), index as u32);
        self.take_nodes(columns, lattice);
        self.fit_wetness();
        self.light = LightBodies::new(&self.scene);
        self.light.set_gravity(gravity);
        self.sleep.gripped.retain(|gripped| *gripped != index);
        self.steps_anew().map_err(fail)?;
        if self.scene.time.sleep_after > 0.0 {
            // Parts are others: everything wakes, and rest is detected anew.
            self.sleep = self.sleep.anew(&self.scene, &self.params, &self.commands.targets);
        } else {
            let mut sleep = sleep::Sleep::new(&self.scene, &self.params);
            (sleep.carried, sleep.gripped) =
                (std::mem::take(&mut self.sleep.carried), std::mem::take(&mut self.sleep.gripped));
            self.sleep = sleep;
        }
        self.apply_sleep();
        Ok(())
    }

    /// Takes over other nodes.
    fn take_nodes(&mut self, columns: Columns, lattice: Lattice) {
        let host = &mut self.stores.host;
        (host.rows.nodes, host.rows.tets) = (columns.rows.nodes, columns.rows.tets);
        host.nodes = columns.nodes;
        host.controls = columns.controls;
        host.bodies.node_wrenches = sorb_kernels::reduce::Wrenches::default();
        self.lattice = lattice;
        self.skins = Arc::default();
        self.clock.node_speed = fastest(&host.nodes.velocity[..host.rows.nodes]);
        if host.rows.nodes == 0 {
            // No step computes it any more.
            host.fluid.interior.fill(0.0);
        }
    }
}

/// Copies what the state has of nodes, but for those of a sponge, from rows to those of the same nodes in another lattice.
fn carry_rows((old, from): (&Columns, &Lattice), (new, to): (&mut Columns, &Lattice), except: u32) {
    let mut rows = Vec::new();
    for color in 0..VERTEX_COLORS {
        for sponge in (0..from.sponges.len() as u32).filter(|sponge| *sponge != except) {
            rows.extend(from.node_range(color, sponge).zip(to.node_range(color, sponge)));
        }
    }
    for column in saved_columns().filter(|column| column.store() == Store::Nodes) {
        let (mut before, mut after) = (Vec::new(), Vec::new());
        append_column(old, column, &mut before);
        if before.is_empty() {
            continue;
        }
        append_column(new, column, &mut after);
        let bytes = column.element().bytes();
        after.resize(new.rows.nodes * bytes, 0);
        for (old, new) in &rows {
            let (old, new) = (*old as usize * bytes, *new as usize * bytes);
            after[new..new + bytes].copy_from_slice(&before[old..old + bytes]);
        }
        take_column(new, column, &after);
    }
}
