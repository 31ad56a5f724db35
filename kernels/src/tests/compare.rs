//! Columns in a form that does not depend on the order of rows and lists, and how far two of them differ.

use crate::{
    body::Wrench,
    column::Plain,
    columns::{Column, Columns, Store},
    cpu::CHUNK,
    divergence::image_rows::Images,
    grid::{
        cells::Cells,
        neighbors::{ListValues, Neighbors},
    },
    kernel::Kernel,
    lanes::LANES,
    params::Params,
    reduce::Extreme,
};

/// Content of a column by identity.
#[derive(Clone, Debug, PartialEq)]
enum Content {
    /// Groups of numbers that share a scale.
    Numbers(Vec<Vec<f64>>),
    /// Sets of identities.
    Sets(Vec<Vec<u32>>),
}

/// Largest error of a column that the kernel wrote, over the scale of what it changed there.
///
/// `found` and `oracle` are the columns after the kernel and after its oracle, `before` those before both.
/// Where the kernel reads the column as well, or moves nodes, errors are over the largest change, not over the
/// largest value. A wrong change must not hide in a large value.
pub(super) fn errors(
    kernel: &Kernel,
    params: &Params,
    before: &Columns,
    found: &Columns,
    oracle: &Columns,
) -> Vec<(Column, f64)> {
    errors_of(kernel, kernel.writes, 0.0, params, before, found, oracle)
}

/// [`errors`] of some of the columns that the kernel wrote. Rounding of the values themselves by up to `ulps` units in
/// the last place of the largest one is no error.
pub(super) fn errors_of(
    kernel: &Kernel,
    columns: &[Column],
    ulps: f64,
    params: &Params,
    before: &Columns,
    found: &Columns,
    oracle: &Columns,
) -> Vec<(Column, f64)> {
    let error = |column: &Column| {
        let base = match column {
            Column::NodePredicted => Some(Column::NodePosition),
            // A sweep that changes next to nothing has converged.
            Column::FluidDrag => None,
            // Small displacements of large coordinates.
            Column::NodeTarget if kernel.reads.contains(&Column::NodeFree) => Some(Column::NodeFree),
            Column::ControlSolid => Some(Column::ControlPosition),
            column => kernel.reads.contains(column).then_some(*column),
        };
        let base = base.map(|column| content(column, params, before, true));
        let [found, oracle] =
            [(found, false), (oracle, true)].map(|(columns, brute)| content(*column, params, columns, brute));
        (*column, distance(base, found, oracle, ulps))
    };
    columns.iter().map(error).collect()
}

fn distance(base: Option<Content>, found: Content, oracle: Content, ulps: f64) -> f64 {
    match (found, oracle) {
        (Content::Numbers(found), Content::Numbers(oracle)) => {
            let base = match base {
                Some(Content::Numbers(base)) => base,
                _ => oracle.iter().map(|group| vec![0.0; group.len()]).collect(),
            };
            let groups = found.iter().zip(&oracle).zip(&base);
            groups
                .map(|((found, oracle), base)| group_distance(base, found, oracle, ulps))
                .fold(0.0, f64::max)
        }
        (found, oracle) => {
            if found == oracle {
                0.0
            } else {
                f64::INFINITY
            }
        }
    }
}

fn group_distance(base: &[f64], found: &[f64], oracle: &[f64], ulps: f64) -> f64 {
    if found.len() != oracle.len() || !found.iter().all(|value| value.is_finite()) {
        return f64::INFINITY;
    }
    let scale = oracle.iter().zip(base).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let error = oracle.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let largest = oracle.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let error = (error - ulps * 0.5 * f64::from(f32::EPSILON) * largest).max(0.0);
    if error > 0.0 { error / scale } else { 0.0 }
}

/// Rows of particles in the order of their ids.
fn by_id(columns: &Columns) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..columns.rows.fluid).collect();
    rows.sort_by_key(|row| columns.fluid.id[*row]);
    rows
}

/// Rows of controls in the order of their nodes; empty before there are any.
fn by_node(columns: &Columns) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..columns.rows.nodes.min(columns.controls.node.len())).collect();
    rows.sort_by_key(|row| columns.controls.node[*row]);
    rows
}

fn content(column: Column, params: &Params, columns: &Columns, brute: bool) -> Content {
    let (fluid, nodes, controls) = (&columns.fluid, &columns.nodes, &columns.controls);
    let (ids, by_id, by_node) = (&fluid.id, by_id(columns), by_node(columns));
    let all_nodes: Vec<usize> = (0..columns.rows.nodes).collect();
    let all_bodies: Vec<usize> = (0..columns.rows.bodies).collect();
    let order = || match column.store() {
        Store::Fluid => &by_id,
        Store::Controls => &by_node,
        Store::Nodes => &all_nodes,
        Store::BodyStore => &all_bodies,
    };
    match columns.data(column).plain() {
        Some(Plain::Rows(data)) => return rows(column, data, order()),
        Some(Plain::Values(data)) => return values(data, order()),
        Some(Plain::Words(_)) | None => {}
    }
    let radii = [params.fluid.smoothing.support_radius, params.coupling.support_radius];
    match column {
        Column::FluidPairs => list_values(&fluid.pairs, &fluid.neighbors, &by_id, ids, columns.rows.fluid),
        Column::FluidPressureSolve => {
            Content::Numbers(fluid.pressure_solve.numbers().map(|number| vec![number]).to_vec())
        }
        Column::FluidViscositySolve => {
            let [rounds, converged, solved, length, share, residual, change] =
                fluid.viscosity_solve.numbers();
            // The share of a direction may be next to nothing, where the length is about one.
            let lone = [rounds, converged, solved, residual, change].map(|number| vec![number]);
            Content::Numbers([&lone[..], &[vec![length, share]]].concat())
        }
        Column::FluidId => Content::Sets(vec![by_id.iter().map(|row| ids[*row]).collect()]),
        Column::FluidCells => boxes(&fluid.cells, &fluid.position, &by_id, ids, radii[0], brute),
        Column::ControlCells => {
            boxes(&controls.cells, &controls.position, &by_node, &controls.node, radii[1], brute)
        }
        Column::FluidNeighbors => sets(&fluid.neighbors, &by_id, ids, columns.rows.fluid),
        Column::FluidControls => sets(&fluid.controls, &by_id, &controls.node, columns.rows.nodes),
        Column::ControlFluid => sets(&controls.fluid, &by_node, ids, columns.rows.fluid),
        Column::FluidControlWeights => {
            list_values(&fluid.control_weights, &fluid.controls, &by_id, &controls.node, columns.rows.nodes)
        }
        Column::ControlFluidWeights => {
            list_values(&controls.fluid_weights, &controls.fluid, &by_node, ids, columns.rows.fluid)
        }
        Column::FluidCorners => {
            let node = |row: &u32| controls.node.get(*row as usize).copied().unwrap_or(u32::MAX);
            Content::Sets(by_id.iter().map(|row| fluid.corners.0[*row].iter().map(node).collect()).collect())
        }
        Column::FluidShares => {
            let rows = by_id.iter().flat_map(|row| fluid.shares.0[*row]);
            let (vectors, weights) =
                rows.map(|row| row.map(f64::from)).map(|[x, y, z, w]| ([x, y, z], w)).unzip();
            let vectors: Vec<[f64; 3]> = vectors;
            Content::Numbers(vec![vectors.concat(), weights])
        }
        Column::ControlCorners => {
            let count = 4 * columns.rows.fluid;
            let identity: Vec<u32> = (0..count).map(|place| 4 * ids[place / 4] + place as u32 % 4).collect();
            sets(&controls.corners, &by_node, &identity, count)
        }
        Column::ControlNode => Content::Sets(vec![by_node.iter().map(|row| controls.node[*row]).collect()]),
        Column::NodePairs => {
            let identity: Vec<u32> = (0..columns.rows.nodes as u32).collect();
            sets(&nodes.pairs, &all_nodes, &identity, columns.rows.nodes)
        }
        Column::FluidExtremes => extremes(fluid.extremes.total()),
        Column::NodeExtremes => extremes(nodes.extremes.total()),
        Column::BodyFluidWrenches => {
            Content::Numbers(totals(&columns.bodies.fluid_wrenches.0, columns.rows.bodies))
        }
        Column::BodyPressureWrenches => {
            Content::Numbers(totals(&columns.bodies.pressure_wrenches.0, columns.rows.bodies))
        }
        Column::FluidImages => images(&fluid.images, &by_id, ids, columns.rows.fluid),
        Column::FluidImageVectors => image_rows(&fluid.images, &fluid.image_vectors.0, &by_id),
        Column::FluidImageRenormalisation => {
            image_rows(&fluid.images, &fluid.image_renormalisation.0, &by_id)
        }
        Column::FluidImageRenormalisationBetween => {
            image_rows(&fluid.images, &fluid.image_renormalisation_between.0, &by_id)
        }
        Column::FluidImagePredicted => image_rows(&fluid.images, &fluid.image_predicted.0, &by_id),
        Column::FluidImageForce => image_rows(&fluid.images, &fluid.image_force.0, &by_id),
        Column::BodyNodeWrenches => {
            Content::Numbers(totals(&columns.bodies.node_wrenches.0, columns.rows.bodies))
        }
        other => panic!("no kernel writes {}", other.name()),
    }
}

/// Vectors in one group, every other lane in a group of its own; zeros where there are no rows.
fn rows(column: Column, data: &[[f32; 4]], order: &[usize]) -> Content {
    let row = |row: &usize| if data.is_empty() { [0.0; 4] } else { data[*row].map(f64::from) };
    let plane = |k: usize| order.iter().map(|place| row(place)[k]).collect();
    let vectors = order.iter().flat_map(|place| row(place)[..3].to_vec()).collect();
    let is_vector = column.element().has_vector();
    Content::Numbers(if is_vector { vec![vectors, plane(3)] } else { (0..4).map(plane).collect() })
}

/// No numbers where there are no rows.
fn values(data: &[f32], order: &[usize]) -> Content {
    if data.is_empty() {
        return Content::Numbers(Vec::new());
    }
    Content::Numbers(vec![order.iter().map(|row| f64::from(data[*row])).collect()])
}

fn extremes(total: Extreme) -> Content {
    let numbers =
        [f64::from(total.speed_squared), f64::from(total.acceleration_squared), f64::from(total.not_finite)];
    Content::Numbers(numbers.map(|number| vec![number]).to_vec())
}

/// Arm of the impulses on the bodies of the tests, about \[m\].
const ARM: f64 = 0.005;

/// Impulses and angular impulses of every body, chunks added up.
fn totals(wrenches: &[Wrench], bodies: usize) -> Vec<Vec<f64>> {
    let mut totals = vec![Wrench::default(); bodies];
    for (index, wrench) in wrenches.iter().enumerate() {
        totals[index % bodies].impulse += wrench.impulse;
        totals[index % bodies].angular_impulse += wrench.angular_impulse;
    }
    // Where forces go through the centre, angular impulses are rounding.
    let both = |wrench: &Wrench| [wrench.impulse.to_array(), (wrench.angular_impulse / ARM).to_array()];
    vec![totals.iter().flat_map(both).flatten().collect()]
}

fn sets(lists: &Neighbors, order: &[usize], identity: &[u32], targets: usize) -> Content {
    let set = |query: &usize| {
        let mut set: Vec<u32> = lists.of(*query, targets).map(|row| identity[row as usize]).collect();
        set.sort_unstable();
        set
    };
    Content::Sets(order.iter().map(set).collect())
}

/// The values of list entries, in the order of their targets.
fn list_values(
    values: &ListValues,
    lists: &Neighbors,
    order: &[usize],
    identity: &[u32],
    targets: usize,
) -> Content {
    let own = |query: &usize| {
        if !lists.has(*query) {
            return Vec::new();
        }
        let (chunk, row, lane) = (lists.chunk(*query), *query % CHUNK, *query % LANES);
        let stored = &values.chunk(*query)[chunk.range(row)];
        let pairs = chunk.group(row).iter().zip(stored).map(|(entry, stored)| (entry[lane], stored[lane]));
        let mut pairs: Vec<_> = pairs.filter(|(target, _)| (*target as usize) < targets).collect();
        pairs.sort_by_key(|(target, _)| identity[*target as usize]);
        pairs.into_iter().map(|(_, value)| f64::from(value)).collect::<Vec<f64>>()
    };
    Content::Numbers(vec![order.iter().flat_map(own).collect()])
}

/// Rows of the images, by the particles that they are images of; the last lane in a group of its own.
fn image_rows(images: &Images, data: &[[f32; 4]], order: &[usize]) -> Content {
    let all: Vec<usize> = order.iter().flat_map(|row| images.of(*row)).collect();
    let row = |image: &usize| data.get(*image).copied().unwrap_or([0.0; 4]).map(f64::from);
    let vectors = all.iter().flat_map(|image| row(image)[..3].to_vec()).collect();
    Content::Numbers(vec![vectors, all.iter().map(|image| row(image)[3]).collect()])
}

/// Images by the particles that they are images of, with a place among all images that does not depend on the order of rows.
fn image_groups(images: &Images, order: &[usize]) -> (Vec<usize>, Vec<u32>, Vec<Vec<f64>>) {
    let all: Vec<usize> = order.iter().flat_map(|row| images.of(*row)).collect();
    let mut groups = Vec::new();
    for rows in [&images.position, &images.foot, &images.along, &images.between] {
        let Content::Numbers(numbers) = image_rows(images, rows, order) else { continue };
        groups.extend(numbers);
    }
    groups.push(all.iter().map(|image| f64::from(images.body[*image].wrapping_add(1))).collect());
    groups.push(all.iter().map(|image| f64::from(images.axes[*image])).collect());
    let mut place = vec![0; images.count()];
    all.iter().enumerate().for_each(|(index, image)| place[*image] = index as u32);
    (all, place, groups)
}

/// Images by the particles that they are images of, and the values of lists by both.
fn images(images: &Images, order: &[usize], ids: &[u32], count: usize) -> Content {
    let (all, place, mut groups) = image_groups(images, order);
    let near = || list_values(&images.pairs, &images.near, order, &place, images.count());
    let particles = || list_values(&images.particle_pairs, &images.particles, &all, ids, count);
    // Without images there are no lists.
    let lists = if all.is_empty() { Vec::new() } else { vec![near(), particles()] };
    for content in lists {
        let Content::Numbers(numbers) = content else { continue };
        groups.extend(numbers);
    }
    Content::Numbers(groups)
}

/// Difference of the images of two devices over the scale of each quantity. Pairs at the very radius are in the lists of one only. Values
/// are next to nothing there, and their sums are compared, plain and weighted by their targets.
#[cfg(feature = "gpu")]
pub(super) fn image_error(found: &Columns, expected: &Columns) -> f64 {
    let groups = |columns: &Columns| {
        let (images, ids, count) = (&columns.fluid.images, &columns.fluid.id, columns.rows.fluid);
        let order = by_id(columns);
        let (all, place, mut groups) = image_groups(images, &order);
        if !all.is_empty() {
            groups.extend(list_sums(&images.pairs, &images.near, &order, &place));
            groups.extend(list_sums(&images.particle_pairs, &images.particles, &all, &ids[..count]));
        }
        groups
    };
    distance(None, Content::Numbers(groups(found)), Content::Numbers(groups(expected)), 0.0)
}

/// Sums of the values of every list, plain and weighted by numbers that belong to the identities of its targets.
#[cfg(feature = "gpu")]
fn list_sums(values: &ListValues, lists: &Neighbors, order: &[usize], identity: &[u32]) -> Vec<Vec<f64>> {
    let weight = |target: u32| {
        let mixed = identity.get(target as usize).map_or(0, |own| (own + 1).wrapping_mul(2_654_435_769));
        f64::from(mixed) / f64::from(u32::MAX)
    };
    let own = |query: &usize| {
        let mut sums = [0.0; 2];
        if lists.has(*query) {
            let (chunk, row, lane) = (lists.chunk(*query), *query % CHUNK, *query % LANES);
            let stored = &values.chunk(*query)[chunk.range(row)];
            for (entry, stored) in chunk.group(row).iter().zip(stored) {
                let value = f64::from(stored[lane]);
                sums[0] += value;
                sums[1] += value * weight(entry[lane]);
            }
        }
        sums
    };
    let all: Vec<[f64; 2]> = order.iter().map(own).collect();
    (0..2).map(|k| all.iter().map(|sums| sums[k]).collect()).collect()
}

/// For every point, the points in a box around it: by the cells, or by looking at all points.
fn boxes(
    cells: &Cells,
    points: &[[f32; 4]],
    order: &[usize],
    identity: &[u32],
    radius: f32,
    brute: bool,
) -> Content {
    let set = |query: &usize| {
        let [x, y, z, _] = points[*query];
        let (low, high) = ([x, y, z].map(|x| x - radius), [x, y, z].map(|x| x + radius));
        let mut rows: Vec<usize> = Vec::new();
        if brute {
            rows.extend_from_slice(order);
        } else {
            let mut runs = Vec::new();
            cells.spans(low, high, &mut runs);
            rows.extend(runs.iter().flat_map(|[begin, end]| *begin as usize..*end as usize));
        }
        let inside = |row: &usize| (0..3).all(|k| (low[k]..=high[k]).contains(&points[*row][k]));
        let mut set: Vec<u32> = rows.into_iter().filter(inside).map(|row| identity[row]).collect();
        set.sort_unstable();
        set
    };
    Content::Sets(order.iter().map(set).collect())
}
