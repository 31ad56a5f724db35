//! Density of the free water over the free share of space, on the nodes of a grid.

use super::closure::{Distances, Surfel};
use super::grid::{Grid, SLAB};
use super::kernels::{Kernel, REACH};
use crate::render::{bands, shapes::Solid};

/// The surface is where the density is half of that of the bulk.
pub(super) const LEVEL: f32 = 0.5;
/// Largest density; what is deep in the water does not matter.
const LARGEST: f32 = 1.5;
/// Density below which there is no surface, whatever the free share.
pub(super) const THIN: f32 = 0.02;
/// Smallest free share that a density is divided by.
const LEAST_FREE: f32 = 0.12;

#[cfg(feature = "gpu")]
shared_with_shaders!(DENSITY: LEVEL, LARGEST, THIN, LEAST_FREE);

/// Density less [`LEVEL`] on all nodes: positive in the water, -0.5 in air. With the distances of the nodes from sponges (m), infinite
/// where there is no water or no sponge near; empty without a sponge.
///
/// A slab of layers is filled by one task, from kernels in their order, so that the result does not depend on threads.
pub(super) fn density(
    grid: &Grid,
    kernels: &[Kernel],
    surfels: &[Surfel],
    bodies: &[Solid<'_>],
    spacing: f32,
) -> (Vec<f32>, Vec<f32>) {
    let by_slab = |near: &dyn Fn(usize) -> std::ops::Range<usize>, count: usize| {
        let mut lists = vec![Vec::new(); grid.slabs()];
        for index in 0..count {
            for slab in near(index) {
                lists[slab].push(index as u32);
            }
        }
        lists
    };
    let own = by_slab(&|i| grid.slabs_near(kernels[i].centre, kernels[i].extent.z), kernels.len());
    let around = by_slab(&|i| grid.slabs_near(surfels[i].place(), REACH * spacing), surfels.len());
    let mut values = vec![0.0_f32; grid.layer() * grid.sides[2]];
    let mut away = vec![f32::INFINITY; if surfels.is_empty() { 0 } else { values.len() }];
    let mut away_by_slab = away.chunks_mut(SLAB * grid.layer());
    let jobs = values.chunks_mut(SLAB * grid.layer()).enumerate();
    let jobs = jobs.map(|(slab, values)| (slab, values, away_by_slab.next())).collect();
    bands::each(jobs, |(slab, values, away): (usize, &mut [f32], Option<&mut [f32]>)| {
        let layers = slab * SLAB..slab * SLAB + values.len() / grid.layer();
        for kernel in own[slab].iter().map(|index| &kernels[*index as usize]) {
            add(grid, layers.start, kernel, values);
        }
        let pieces = around[slab].iter().map(|index| surfels[*index as usize]);
        let distances = Distances::new(grid, layers.clone(), (pieces, bodies), values, spacing);
        if distances.are_free() {
            values.iter_mut().for_each(|value| *value = value.min(LARGEST) - LEVEL);
            return;
        }
        for (node, value) in values.iter_mut().enumerate() {
            if *value > THIN {
                let (x, row) = (node % grid.sides[0], node / grid.sides[0]);
                let place = grid.node(x, row % grid.sides[1], row / grid.sides[1] + layers.start);
                *value /= distances.free((node, grid.mirrored(node)), place).max(LEAST_FREE);
            }
            *value = value.min(LARGEST) - LEVEL;
        }
        if let Some(away) = away {
            distances.copy_to(away);
        }
    });
    (values, away)
}

/// Adds a kernel to the nodes of a slab, eight by eight.
fn add(grid: &Grid, first: usize, kernel: &Kernel, values: &mut [f32]) {
    let layers = first..first + values.len() / grid.layer();
    let [xx, xy, xz, yy, yz, zz] = kernel.metric;
    grid.rows(kernel.centre, kernel.extent, layers, |y, z, x0, x1| {
        let r = grid.node(x0, y, z + first) - kernel.centre;
        let slope = 2.0 * (xy * r.y + xz * r.z);
        let rest = 1.0 - (yy * r.y * r.y + zz * r.z * r.z + 2.0 * yz * r.y * r.z);
        // Its largest value on the whole row.
        if 4.0 * xx * rest + slope * slope <= 0.0 {
            return;
        }
        let row = (z * grid.sides[1] + y) * grid.sides[0];
        for (n, lanes) in values[row + x0..row + x1].as_chunks_mut::<8>().0.iter_mut().enumerate() {
            for (lane, value) in lanes.iter_mut().enumerate() {
                let x = r.x + (n * 8 + lane) as i32 as f32 * grid.cell.x;
                let share = (rest - (xx * x + slope) * x).max(0.0);
                *value += kernel.mass * (share * share) * share;
            }
        }
    });
}
