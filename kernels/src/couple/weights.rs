//! Weights of the coupling on the host, where a device has made the lists: the device stores no weights to fetch.

use crate::{
    columns::{Column, Columns, lane},
    cpu::CHUNK,
    lanes::LANES,
    params::Params,
    smoothing::Wendland,
};

/// Columns of values beside lists, with the lists and the positions that they are computed from.
const SOURCES: [(Column, Column, &[Column]); 3] = [
    (Column::FluidControlWeights, Column::FluidControls, POINTS),
    (Column::ControlFluidWeights, Column::ControlFluid, POINTS),
    (Column::FluidPairs, Column::FluidNeighbors, &[Column::FluidPredicted]),
];

const POINTS: &[Column] = &[Column::FluidPosition, Column::ControlPosition];

/// Lists and positions that a column of values is computed from. Host and device each compute it, so that it is not transferred. None
/// for other columns.
#[must_use]
pub fn sources(column: Column) -> Option<(Column, &'static [Column])> {
    SOURCES.iter().find(|(values, ..)| *values == column).map(|(_, lists, points)| (*lists, *points))
}

/// Computes node volume times W for all entries of the lists that a column of weights belongs to, as `couple::interior` and
/// `couple::saturation` do; other columns are left alone.
pub fn weigh(params: &Params, columns: &mut Columns, column: Column) {
    if column == Column::FluidPairs {
        return pairs(params, columns);
    }
    let radius = f64::from(params.coupling.support_radius);
    let Columns { fluid, controls, .. } = columns;
    let is_of_fluid = column == Column::FluidControlWeights;
    let (lists, values, queries, targets) = match column {
        Column::FluidControlWeights => {
            (&fluid.controls, &mut fluid.control_weights, &fluid.position, &controls.position)
        }
        Column::ControlFluidWeights => {
            (&controls.fluid, &mut controls.fluid_weights, &controls.position, &fluid.position)
        }
        _ => return,
    };
    let weight = |query: usize, target: u32| {
        let (Some(query), Some(target)) = (queries.get(query), targets.get(target as usize)) else {
            return 0.0;
        };
        let square: f64 = (0..3).map(|axis| f64::from(query[axis] - target[axis]).powi(2)).sum();
        let volume = if is_of_fluid {
            target[lane::controls::position::VOLUME]
        } else {
            query[lane::controls::position::VOLUME]
        };
        (f64::from(volume) * Wendland::value_f64(radius, square.sqrt())) as f32
    };
    for (chunk, values) in values.match_lists(lists).0.iter_mut().enumerate() {
        let first = chunk * CHUNK;
        let lists = lists.chunk(first);
        for row in (0..CHUNK).step_by(LANES) {
            for (entry, values) in lists.group(row).iter().zip(&mut values[lists.range(row)]) {
                *values = std::array::from_fn(|lane| weight(first + row + lane, entry[lane]));
            }
        }
    }
}

/// The factors of pairs, as `sph::factors` computes them.
fn pairs(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let radius = f64::from(params.fluid.smoothing.support_radius);
    let volume = f64::from(params.fluid.particle_mass / params.fluid.rest_density);
    let (lists, predicted) = (&fluid.neighbors, &fluid.predicted);
    let factor = |query: usize, target: u32| {
        let (Some(query), Some(target)) = (predicted.get(query), predicted.get(target as usize)) else {
            return 0.0;
        };
        let square: f64 = (0..3).map(|axis| f64::from(query[axis] - target[axis]).powi(2)).sum();
        (volume * Wendland::gradient_f64(radius, square.sqrt())) as f32
    };
    for (chunk, values) in fluid.pairs.match_lists(lists).0.iter_mut().enumerate() {
        let first = chunk * CHUNK;
        let lists = lists.chunk(first);
        for row in (0..CHUNK).step_by(LANES) {
            for (entry, values) in lists.group(row).iter().zip(&mut values[lists.range(row)]) {
                *values = std::array::from_fn(|lane| factor(first + row + lane, entry[lane]));
            }
        }
    }
}
