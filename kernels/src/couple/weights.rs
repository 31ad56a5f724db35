//! Weights of the coupling on the host, where a device has made the lists: the device stores no weights to fetch.

use glam::Vec3;

use crate::{
    columns::{Column, Columns, lane},
    cpu::CHUNK,
    divergence::{image_rows::NO_BODY, reflect::mirrored_renormalisation},
    lanes::LANES,
    params::Params,
    smoothing::Wendland,
};

/// Columns of values beside lists, with the lists and the positions that they are computed from.
const SOURCES: [(Column, Column, &[Column]); 5] = [
    (Column::FluidControlWeights, Column::FluidControls, POINTS),
    (Column::ControlFluidWeights, Column::ControlFluid, POINTS),
    (Column::FluidPairs, Column::FluidNeighbors, &[Column::FluidPredicted, Column::FluidPosition]),
    (Column::FluidImageRenormalisation, Column::FluidImages, RENORMALISATION),
    (Column::FluidImageRenormalisationBetween, Column::FluidImages, RENORMALISATION),
];

const RENORMALISATION: &[Column] = &[Column::FluidRenormalisation, Column::FluidRenormalisationBetween];

const POINTS: &[Column] = &[Column::FluidPosition, Column::ControlPosition];

/// Lists and positions that a column of values is computed from. Host and device each compute it, so that it is not transferred. None
/// for other columns.
#[must_use]
pub fn sources(column: Column) -> Option<(Column, &'static [Column])> {
    SOURCES.iter().find(|(values, ..)| *values == column).map(|(_, lists, points)| (*lists, *points))
}

/// Computes node volume times W for all entries of the lists that a column of weights belongs to, as `couple::interior` and
/// `couple::saturation` do. Other columns are left alone.
pub fn weigh(params: &Params, columns: &mut Columns, column: Column) {
    if column == Column::FluidPairs {
        return pairs(params, columns);
    }
    if matches!(column, Column::FluidImageRenormalisation | Column::FluidImageRenormalisationBetween) {
        return mirror_renormalisation(columns);
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

/// The renormalisation of images, as `divergence::moments` computes it.
fn mirror_renormalisation(columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let images = &fluid.images;
    let renormalisation = [&fluid.renormalisation[..], &fluid.renormalisation_between[..]];
    let rows = (0..images.position.len()).map(|image| match images.body.get(image) {
        Some(&NO_BODY) => {
            let source = images.source[image] as usize;
            mirrored_renormalisation(images.signs(image), renormalisation.map(|rows| rows[source]))
        }
        _ => ([0.0; 4], [0.0; 4]),
    });
    (fluid.image_renormalisation.0, fluid.image_renormalisation_between.0) = rows.unzip();
}

/// The factors of pairs, as `sph::factors` computes them, and with a solve for the divergence `divergence::moments`.
fn pairs(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let (smoothing, volume) = (&params.fluid.smoothing, params.fluid.rest_volume());
    let lists = &fluid.neighbors;
    let points = if params.fluid.divergence().is_some() { &fluid.position } else { &fluid.predicted };
    let periods = params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
    let factor = |query: usize, target: u32| {
        let (Some(query), Some(target)) = (points.get(query), points.get(target as usize)) else {
            return 0.0;
        };
        let apart = |axis: usize| {
            let (apart, period) = (f64::from(query[axis] - target[axis]), f64::from(periods[axis]));
            if period > 0.0 { apart - period * (apart / period).round() } else { apart }
        };
        let square: f64 = (0..3).map(|axis| apart(axis) * apart(axis)).sum();
        volume * smoothing.gradient_at(square.sqrt() as f32)
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
