//! Sponges and bodies as shaders have them.

use glam::Vec3;
use sorb_kernels::gpu::ShapeKind;

use super::declarations::{BODY_ROWS, TREE_NOTHING};
use crate::render::{
    Look,
    rays::{Triangle, tint, tree::Tree},
    sponge::Surface,
    stage::Stage,
    water::{Cells, Surfel},
};
use crate::rigid::Shape;

/// A row of four numbers.
pub(super) type Row = [f32; 4];

/// The bodies of a picture.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    pub(super) rows: Vec<Row>,
    /// Bodies that rays end at, those and the ones that they pass, and all.
    pub(super) opaque: u32,
    pub(super) seen: u32,
    pub(super) all: u32,
}

fn row(v: Vec3, w: f32) -> Row {
    v.extend(w).to_array()
}

fn bits(number: usize) -> f32 {
    f32::from_bits(number as u32)
}

impl Bodies {
    /// Bodies that rays end at, then those that they pass, then a floor.
    pub(super) fn new(stage: &Stage<'_>) -> Self {
        let floor = stage.ground().and_then(|(_, body)| body);
        let mut order: Vec<usize> = (0..stage.solids.len()).filter(|index| Some(*index) != floor).collect();
        order.sort_by_key(|index| stage.solids[*index].is_clear());
        let opaque = order.iter().filter(|index| !stage.solids[**index].is_clear()).count();
        let seen = order.len();
        order.extend(floor);
        let mut rows = Vec::new();
        let mut lists = Vec::new();
        let first = order.len() * BODY_ROWS as usize;
        for index in &order {
            let body = &stage.solids[*index];
            let (kind, size, list) = shape(body.shape, first, &mut lists);
            let own = body.own_colour().is_some();
            let wire = f32::from_bits(u32::from(body.look == Look::Wire));
            let [x, y, z] = [body.rotation.x_axis, body.rotation.y_axis, body.rotation.z_axis];
            rows.extend([
                row(body.position, body.radius.min(super::scene::FAR_AWAY)),
                row(x, f32::from_bits(kind as u32)),
                row(y, wire),
                row(z, 0.0),
                row(size, 0.0),
                row(body.colour(), f32::from(u8::from(own))),
                row(tint(body), 0.0),
                [bits(list.0), bits(list.1), 0.0, 0.0],
            ]);
        }
        rows.extend(lists);
        let [opaque, seen, all] = [opaque, seen, order.len()].map(|count| count as u32);
        Self { rows, opaque, seen, all }
    }
}

/// Kind and size of a shape, and its first row and their number in the lists, which begin at `first`.
fn shape(shape: &Shape, first: usize, lists: &mut Vec<Row>) -> (ShapeKind, Vec3, (usize, usize)) {
    match shape {
        Shape::Plane => (ShapeKind::Plane, Vec3::ZERO, (0, 0)),
        Shape::Sphere { radius } => (ShapeKind::Sphere, Vec3::splat(*radius), (0, 0)),
        Shape::Cuboid { half_extents } => (ShapeKind::Cuboid, *half_extents, (0, 0)),
        Shape::Capsule { half_height, radius } => {
            (ShapeKind::Capsule, Vec3::new(*radius, *half_height, 0.0), (0, 0))
        }
        Shape::Hull { planes, .. } => {
            let list = (first + lists.len(), planes.len());
            lists.extend(planes.iter().map(|(normal, offset)| row(*normal, *offset)));
            (ShapeKind::Hull, Vec3::ZERO, list)
        }
        Shape::Compound(compound) => {
            let list = (first + lists.len(), compound.parts.len());
            let mut planes_at = list.0 + 2 * compound.parts.len();
            for part in &compound.parts {
                lists.push(row(part.centre, 0.0));
                lists.push([bits(planes_at), bits(part.planes().len()), 0.0, 0.0]);
                planes_at += part.planes().len();
            }
            let planes = compound.parts.iter().flat_map(|part| part.planes());
            lists.extend(planes.map(|(normal, offset)| row(*normal, *offset)));
            (ShapeKind::Compound, Vec3::ZERO, list)
        }
    }
}

/// The sponges: a tree over their triangles, these, and their nodes.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    pub(super) rows: Vec<Row>,
    pub(super) has_tree: bool,
    pub(super) triangles_at: u32,
    pub(super) nodes_at: u32,
    pub(super) nodes: u32,
}

impl Mesh {
    /// The sponges of a picture, or nothing where a view hides them.
    pub(super) fn new(sponge: &Surface, is_hidden: bool) -> Self {
        let triangles = if is_hidden { &[][..] } else { &sponge.triangles[..] };
        let tree: Tree<Triangle> =
            Tree::new(triangles.iter().map(|(_, corners)| corners.map(|node| sponge.positions[node])));
        let mut rows = Vec::new();
        for (low, high, parts) in tree.parts() {
            rows.extend([low[0], high[0], low[1], high[1], low[2], high[2]]);
            // The number of shapes of a leaf is in the highest bits.
            let word =
                |part: Option<(u32, u32)>| part.map_or(TREE_NOTHING, |(first, count)| first | count << 28);
            rows.push(parts.map(|part| f32::from_bits(word(part))));
            rows.push([0.0; 4]);
        }
        let triangles_at = rows.len() as u32;
        for (index, corners) in tree.shapes() {
            let nodes = triangles[index as usize].1;
            rows.extend([0, 1, 2].map(|corner| row(corners[corner], bits(nodes[corner]))));
        }
        let nodes_at = rows.len() as u32;
        let nodes = if is_hidden { 0 } else { sponge.positions.len() };
        for node in 0..nodes {
            rows.extend([
                row(sponge.positions[node], sponge.wetness[node]),
                row(sponge.normals[node], 0.0),
                row(sponge.rest[node], 0.0),
            ]);
        }
        Self { rows, has_tree: !triangles.is_empty(), triangles_at, nodes_at, nodes: nodes as u32 }
    }
}

/// Pieces of the surface of sponges, by the cells of a grid.
pub(super) fn surfels(surfels: &[Surfel], side: f32) -> (Cells, Vec<Row>) {
    let places: Vec<Vec3> = surfels.iter().map(Surfel::place).collect();
    let cells = Cells::new(&places, side);
    let rows = cells.rows(0..surfels.len()).iter().flat_map(|index| {
        let surfel = &surfels[*index as usize];
        [row(surfel.place(), 0.0), row(surfel.normal(), 0.0)]
    });
    let rows = rows.collect();
    (cells, rows)
}
