//! Sponges that commands put elsewhere.

use glam::{Quat, Vec3};
use sorb_kernels::columns::lane;

use super::{
    World,
    sleep::{Kind, box_of},
};
use crate::{
    command::Command,
    scene::Domain,
    setup::{TOUCH, body_setup, cutter},
    sponge::{Located, TetGrid},
    water::APART,
};

/// Smallest cell of a search where there are no sponges yet \[m\].
const SMALLEST: f32 = 1e-4;

/// A sponge at another place.
#[derive(Debug)]
pub(crate) struct Placed {
    /// Rows of its nodes, in order.
    rows: Vec<usize>,
    /// Where they go \[m\].
    places: Vec<Vec3>,
    /// Rows of the particles in its pores, and where they go \[m\].
    water: Vec<(usize, Vec3)>,
}

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

pub(super) fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)))
}

/// Whether boxes meet.
fn meet(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

impl World {
    /// A sponge in its shape at rest, as large as it has swollen, with the middle of its block at a pose.
    pub(crate) fn placed(&self, sponge: usize, (position, rotation): (Vec3, Quat)) -> Placed {
        let (nodes, scene) = (&self.columns().nodes, &self.scene.sponges[sponge]);
        let rows: Vec<usize> = self.node_rows(sponge).into_iter().flatten().collect();
        let wetness =
            |row: &usize| nodes.wetting.get(*row).map_or(0.0, |own| own[lane::nodes::wetting::WETNESS]);
        let wetness = rows.iter().map(wetness).sum::<f32>() / rows.len().max(1) as f32;
        let size = self.params.sponges[sponge].wetting.size(wetness);
        let middle = scene.position + 0.5 * scene.size();
        let rotation = rotation.as_dquat().normalize().as_quat();
        let new = |row: &usize| position + rotation * ((place(&self.lattice.position[*row]) - middle) * size);
        let places: Vec<Vec3> = rows.iter().map(new).collect();
        let water = self.carried_water(sponge, (&rows, &places));
        Placed { rows, places, water }
    }

    /// Tets of a sponge.
    pub(super) fn tets_of(&self, sponge: usize) -> Vec<[u32; 4]> {
        let tets = self.lattice.tets.iter().zip(&self.lattice.tet_sponge);
        tets.filter(|(_, own)| **own as usize == sponge).map(|(tet, _)| *tet).collect()
    }

    /// The particles in the tets of a sponge, and where they go with its nodes.
    fn carried_water(&self, sponge: usize, (rows, places): (&[usize], &[Vec3])) -> Vec<(usize, Vec3)> {
        let (nodes, tets) = (self.node_positions(), self.tets_of(sponge));
        let own = bounds(rows.iter().map(|row| place(&nodes[*row])));
        let grid = TetGrid::new((nodes, &tets), own, self.scene.sponges[sponge].edge);
        let mut new = vec![Vec3::ZERO; nodes.len()];
        rows.iter().zip(places).for_each(|(row, place)| new[*row] = *place);
        let (low, high) = match self.scene.domain {
            Domain::Box { minimum, maximum, .. } => (minimum, maximum),
            Domain::Open => (Vec3::NEG_INFINITY, Vec3::INFINITY),
        };
        let mut water = Vec::new();
        for (row, point) in self.particle_positions().iter().map(place).enumerate() {
            let is_near = point.cmpge(own.0).all() && point.cmple(own.1).all();
            let Some(Located { tet, weights }) = is_near.then(|| grid.find(point)).flatten() else {
                continue;
            };
            let corners = tets[tet as usize].iter().zip(weights);
            let there: Vec3 = corners.map(|(node, weight)| new[*node as usize] * weight).sum();
            water.push((row, there.clamp(low, high)));
        }
        water
    }

    /// Why a sponge cannot be somewhere; none if it can.
    pub(crate) fn place_refusal(&self, sponge: usize, placed: &Placed) -> Option<String> {
        let (edge, own) = (self.scene.sponges[sponge].edge, bounds(placed.places.iter().copied()));
        if let Domain::Box { minimum, maximum, .. } = self.scene.domain {
            let slack = 1e-3 * edge;
            if own.0.cmplt(minimum - slack).any() || own.1.cmpgt(maximum + slack).any() {
                return Some(format!(
                    "it would be outside of the container {minimum} to {maximum}: {} to {}",
                    own.0, own.1
                ));
            }
        }
        let in_body = |body: &crate::rigid::Body| {
            body.touches_nodes && placed.places.iter().any(|point| body.distance(*point) < -TOUCH * edge)
        };
        if let Some(body) = self.bodies().iter().position(in_body) {
            return Some(format!("it would be in body number {body}, `{}`", self.scene.bodies[body].name));
        }
        let mut new = self.node_positions().to_vec();
        for (row, place) in placed.rows.iter().zip(&placed.places) {
            new[*row] = place.extend(0.0).to_array();
        }
        let tets = self.tets_of(sponge);
        if let Some(other) = self.sponge_at(Some(sponge), &placed.places, (&new, &tets), own) {
            return Some(format!(
                "it would be in sponge number {other}, `{}`",
                self.scene.sponges[other].name
            ));
        }
        if self.is_claimed((own.0 - edge, own.1 + edge)) {
            return Some("a command that waits brings something there; take a step first".to_owned());
        }
        let wet = self.water_in_the_way(placed);
        (wet > 0)
            .then(|| format!("{wet} of the {} particles in it would be in other water", placed.water.len()))
    }

    /// A sponge, but for one, that overlaps nodes at some places in a box, which have tets of their own.
    pub(super) fn sponge_at(
        &self,
        except: Option<usize>,
        places: &[Vec3],
        (new, tets): (&[[f32; 4]], &[[u32; 4]]),
        own: (Vec3, Vec3),
    ) -> Option<usize> {
        let nodes = self.node_positions();
        let (other_tets, others): (Vec<_>, Vec<_>) = {
            let all = self.lattice.tets.iter().zip(&self.lattice.tet_sponge);
            all.filter(|(_, of)| Some(**of as usize) != except).map(|(tet, of)| (*tet, *of as usize)).unzip()
        };
        let edge = self.params.sponges.iter().map(|own| own.edge).fold(0.0, f32::max).max(SMALLEST);
        let grid = TetGrid::new((nodes, &other_tets), own, edge);
        if let Some(found) = places.iter().find_map(|point| grid.find(*point)) {
            return Some(others[found.tet as usize]);
        }
        let grid = TetGrid::new((new, tets), own, edge);
        let mut rows = nodes.iter().zip(&self.lattice.node_sponge);
        let meets =
            |(row, of): &(&[f32; 4], &u32)| Some(**of as usize) != except && grid.find(place(row)).is_some();
        rows.find(meets).map(|(_, of)| *of as usize)
    }

    /// Particles that it brings along and that would be in other water.
    fn water_in_the_way(&self, placed: &Placed) -> usize {
        let distance = APART * self.params.fluid.spacing;
        let mut goes = vec![false; self.particle_positions().len()];
        placed.water.iter().for_each(|(row, _)| goes[*row] = true);
        let (low, high) = bounds(placed.water.iter().map(|(_, point)| *point));
        let stays = self.particle_positions().iter().map(place).zip(&goes);
        let stays = stays.filter(|(point, goes)| {
            !**goes && point.cmpge(low - distance).all() && point.cmple(high + distance).all()
        });
        let mut near = crate::water::Points::new(distance);
        stays.for_each(|(point, _)| near.insert(point));
        placed.water.iter().filter(|(_, point)| near.is_near(*point)).count()
    }

    /// Whether a command that waits brings something to a box.
    pub(crate) fn is_claimed(&self, own: (Vec3, Vec3)) -> bool {
        self.commands.pending.iter().filter_map(|command| self.claim(command)).any(|claim| meet(own, claim))
    }

    /// The box in which a command brings something that is there at once \[m\].
    fn claim(&self, command: &Command) -> Option<(Vec3, Vec3)> {
        match command {
            Command::PlaceSponge { sponge, position, rotation, .. } => {
                let placed = self.placed(sponge.index(), (*position, *rotation));
                Some(bounds(placed.places.iter().copied()))
            }
            Command::AddSponge { description, .. } => Some((description.position, description.maximum())),
            Command::Pour { region, .. } => Some(region.bounds()),
            Command::AddBody { description, .. } => {
                let spacing = self.params.fluid.spacing;
                let setup = body_setup(description, spacing).ok()?;
                Some(box_of(&cutter(description, &setup)))
            }
            _ => None,
        }
    }

    /// Puts a sponge elsewhere, with the water in its pores.
    pub(super) fn place_sponge(&mut self, sponge: usize, pose: (Vec3, Quat), velocity: Vec3) {
        let Placed { rows, places, water } = self.placed(sponge, pose);
        self.let_go(&rows);
        let [x, y, z] = velocity.to_array();
        let columns = &mut self.stores.host;
        for (row, place) in rows.iter().zip(&places) {
            let position = &mut columns.nodes.position[*row];
            *position = place.extend(position[lane::nodes::position::INVERSE_MASS]).to_array();
            columns.nodes.velocity[*row] = [x, y, z, 0.0];
            // What moved it in the last step says nothing of the next one.
            if let Some(driven) = columns.nodes.driven.get_mut(*row) {
                *driven = [0.0; 4];
            }
        }
        // With a solve for the divergence, the pressure of the water that it was in would press it out.
        let is_solved = self.params.fluid.divergence().is_some();
        for (row, place) in &water {
            columns.fluid.position[*row] = place.extend(columns.fluid.position[*row][3]).to_array();
            let kept = if is_solved { 0.0 } else { columns.fluid.velocity[*row][3] };
            columns.fluid.velocity[*row] = [x, y, z, kept];
        }
        let speed = velocity.length();
        self.clock.node_speed = self.clock.node_speed.max(speed);
        if !water.is_empty() {
            self.clock.fluid_speed = self.clock.fluid_speed.max(speed);
        }
        let has_water = !water.is_empty();
        self.wake_kinds(|kind| kind == Kind::Sponge(sponge) || kind == Kind::Fluid && has_water);
        // Nor may a step leave out what it is beside now.
        self.take_bounds();
        self.wake_what_is_reached();
    }
}
