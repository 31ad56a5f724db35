//! Neighbour search by all pairs.

use glam::DVec3;

use super::{apart, vectors};
use crate::{column::FAR_ROW, columns::Columns, grid::neighbors::Neighbors, params::Params};

/// Any order of the rows is valid: here the present one.
pub(crate) fn sort_fluid(_params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let fluid = &mut columns.fluid;
    fluid.cells.order = (0..count as u32).collect();
    fluid.position[count..].fill(FAR_ROW);
    fluid.velocity[count..].fill([0.0; 4]);
}

pub(crate) fn fluid_neighbors(params: &Params, columns: &mut Columns) {
    let points = vectors(&columns.fluid.position, columns.rows.fluid);
    let radius = params.fluid.list_radius();
    columns.fluid.neighbors = lists(params, &points, &points, columns.fluid.position.len(), radius);
}

/// For every query the targets that are nearer than the radius; `rows` lists in all.
pub(super) fn lists(
    params: &Params,
    queries: &[DVec3],
    targets: &[DVec3],
    rows: usize,
    radius: f32,
) -> Neighbors {
    let square = f64::from(radius) * f64::from(radius);
    let near = |query: &DVec3| {
        let target = |row: &usize| apart(params, targets[*row], *query).length_squared() < square;
        (0..targets.len()).filter(target).map(|row| row as u32).collect()
    };
    let mut lists: Vec<Vec<u32>> = queries.iter().map(near).collect();
    lists.resize(rows, Vec::new());
    Neighbors::from_lists(&lists, targets.len() as u32)
}
