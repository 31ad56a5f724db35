//! What a dynamic body can hold.

use glam::Vec3;

use super::{World, commands::rows_of};
use crate::{
    command::{Command, Nodes},
    handle::BodyHandle,
    rigid::{BodyKind, MassProperties},
    scene,
    setup::body_setup,
};

/// Mass \[kg\] of nodes, and their moment of inertia about a place \[kg m^2\].
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    mass: f64,
    moment: f64,
}

impl World {
    /// Why a body cannot hold further nodes; none if it can. The engine does not know what a body holds. A ball that rolls
    /// would swing nodes that are many radii away, at many times its speed.
    pub(crate) fn grip_refusal(&self, body: BodyHandle, nodes: &Nodes) -> Option<String> {
        let is_dynamic = self.slots_after_commands().kind(body) == Some(BodyKind::Dynamic);
        is_dynamic.then(|| self.load_refusal(body, Some(nodes))).flatten()
    }

    /// Why a body cannot be of a kind, with what it holds; none if it can.
    pub(crate) fn kind_refusal(&self, body: BodyHandle, kind: BodyKind) -> Option<String> {
        (kind == BodyKind::Dynamic).then(|| self.load_refusal(body, None)).flatten()
    }

    /// Why a body is too light for the nodes that it holds, and for further ones; none if it is not.
    fn load_refusal(&self, body: BodyHandle, further: Option<&Nodes>) -> Option<String> {
        let (description, place) = self.as_described(body)?;
        let shape = body_setup(description, self.params.fluid.spacing).ok()?.shape;
        let own = MassProperties::new(&shape, description.density)?;
        let least = own.inertia.x_axis.x.min(own.inertia.y_axis.y).min(own.inertia.z_axis.z);
        let Load { mass, moment } = self.load(body, further, place);
        (mass > own.mass || moment > least).then(|| {
            format!(
                "the body has {:.1e} kg and {least:.1e} kg m^2, and the nodes that it would hold {mass:.1e} kg and {moment:.1e} kg m^2 \
                 about it: a dynamic body cannot hold more than it has",
                own.mass
            )
        })
    }

    /// The description of a body, which a command that waits may bring, and the place of its centre of mass.
    fn as_described(&self, body: BodyHandle) -> Option<(&scene::Body, Vec3)> {
        let brought = self.commands.pending.iter().find_map(|command| match command {
            Command::AddBody { body: own, description } if *own == body => Some(&**description),
            _ => None,
        });
        match brought {
            Some(description) => {
                let setup = body_setup(description, self.params.fluid.spacing).ok()?;
                Some((description, setup.state.position))
            }
            None => {
                let state = self.bodies().get(body.index())?.state;
                Some((self.scene.bodies.get(body.index())?, state.position))
            }
        }
    }

    /// What a body holds already, and further nodes.
    fn load(&self, body: BodyHandle, further: Option<&Nodes>, place: Vec3) -> Load {
        let columns = self.columns();
        let nodes = &columns.nodes;
        let is_own = |row: &usize| nodes.grip.get(*row) == Some(&(body.index() as u32));
        let mut rows: Vec<usize> = (0..columns.rows.nodes).filter(is_own).collect();
        rows.extend(further.map(|nodes| rows_of(columns, nodes)).unwrap_or_default());
        rows.sort_unstable();
        rows.dedup();
        let mut load = Load::default();
        for row in rows {
            let [x, y, z, _] = nodes.position[row];
            let mass = self.scene.sponges[nodes.sponge[row] as usize].density * nodes.volume[row];
            load.mass += f64::from(mass);
            load.moment += f64::from(mass * place.distance_squared(Vec3::new(x, y, z)));
        }
        load
    }
}
