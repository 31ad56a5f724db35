//! Room for new particles: inside the container, and outside of bodies, sponges and water.

use std::{collections::BTreeMap, fmt};

use glam::Vec3;

use crate::{command::Region, scene::Domain, setup::Beside, sponge::TetGrid, world::World};

/// Distance from walls within which there are no new particles, over the spacing. Those of a block begin at half a spacing.
const WALL: f32 = 0.25;

/// Distance from other particles within which there are no new ones, over the spacing: pressure would throw them apart.
pub(crate) const APART: f32 = 0.8;

/// Places for particles in a region, and why others have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Room {
    pub(crate) points: Vec<Vec3>,
    /// Which of the points that were asked for these are.
    pub(crate) places: Vec<usize>,
    outside: u64,
    in_bodies: u64,
    in_sponges: u64,
    in_water: u64,
}

impl Room {
    /// Room at all of some points.
    pub(crate) fn of(points: Vec<Vec3>) -> Self {
        Self { places: (0..points.len()).collect(), points, ..Self::default() }
    }

    /// Places without room.
    pub(crate) fn left_out(&self) -> u64 {
        self.outside + self.in_bodies + self.in_sponges + self.in_water
    }
}

impl fmt::Display for Room {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { points, outside, in_bodies, in_sponges, in_water, .. } = self;
        write!(
            out,
            "room for {} particles; {outside} places are outside of the container, {in_bodies} in bodies, \
             {in_sponges} in sponges, {in_water} in water",
            points.len()
        )
    }
}

/// Points by cells.
#[derive(Debug)]
pub(crate) struct Points {
    cell: f32,
    cells: BTreeMap<[i64; 3], Vec<Vec3>>,
}

impl Points {
    /// In cells of some size \[m\].
    pub(crate) fn new(cell: f32) -> Self {
        Self { cell, cells: BTreeMap::new() }
    }

    fn cell_of(&self, point: Vec3) -> [i64; 3] {
        (point / self.cell).floor().to_array().map(|cell| cell as i64)
    }

    pub(crate) fn insert(&mut self, point: Vec3) {
        let cell = self.cell_of(point);
        self.cells.entry(cell).or_default().push(point);
    }

    /// Whether a point is less than a cell away from another.
    pub(crate) fn is_near(&self, point: Vec3) -> bool {
        let [x, y, z] = self.cell_of(point);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let mut near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.any(|other| other.distance_squared(point) < self.cell * self.cell)
    }
}

impl World {
    /// The room for new particles in a region, as the state is.
    pub(crate) fn room(&self, region: &Region) -> Room {
        self.room_for(region.lattice(self.params.fluid.spacing), region.bounds())
    }

    /// The room for new particles at points in a box.
    pub(crate) fn room_for(&self, points: impl Iterator<Item = Vec3>, (low, high): (Vec3, Vec3)) -> Room {
        let spacing = self.params.fluid.spacing;
        let beside = Beside::new(&self.params, self.bodies());
        let edge = self.params.sponges.iter().map(|sponge| sponge.edge).fold(0.0, f32::max);
        let nodes = self.node_positions();
        let tets = TetGrid::new((nodes, &self.lattice().tets), (low, high), edge.max(1e-4));
        let water = self.water_near((low - spacing, high + spacing), APART * spacing);
        let mut room = Room::default();
        for (place, point) in points.enumerate() {
            let Some(point) = beside.outside(point) else {
                room.in_bodies += 1;
                continue;
            };
            if !self.is_in_container(point, WALL * spacing) {
                room.outside += 1;
            } else if tets.find(point).is_some() {
                room.in_sponges += 1;
            } else if water.is_near(point) {
                room.in_water += 1;
            } else {
                room.points.push(point);
                room.places.push(place);
            }
        }
        room
    }

    /// Whether a point is in the container, some distance \[m\] from its walls.
    fn is_in_container(&self, point: Vec3, margin: f32) -> bool {
        let Domain::Box { minimum, maximum, periodic } = self.scene().domain else { return true };
        let margin = Vec3::select(periodic.into(), Vec3::ZERO, Vec3::splat(margin));
        point.cmpge(minimum + margin).all() && point.cmple(maximum - margin).all()
    }

    /// The particles in a box, and their images along periodic axes, in cells of some size \[m\].
    fn water_near(&self, (low, high): (Vec3, Vec3), cell: f32) -> Points {
        let mut points = Points::new(cell);
        let periods = self.params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
        let times = |axis: usize| if periods[axis] > 0.0 { -1..=1 } else { 0..=0 };
        let shift = |x: i32, y: i32, z: i32| Vec3::new(x as f32, y as f32, z as f32) * periods;
        let mut shifts = Vec::new();
        for x in times(0) {
            for y in times(1) {
                times(2).for_each(|z| shifts.push(shift(x, y, z)));
            }
        }
        for row in self.particle_positions() {
            let point = Vec3::new(row[0], row[1], row[2]);
            for shift in &shifts {
                let image = point + *shift;
                if image.cmpge(low).all() && image.cmple(high).all() {
                    points.insert(image);
                }
            }
        }
        points
    }
}
