//! Vertex block descent, node by node and tet by tet.

use glam::{DMat3, DVec3};

use super::{keep, obstacles, pbd::SHAPE, row, shapes, touch, vector, wetting};
use crate::{
    body::{Body, Wrench},
    columns::{BodyStore, Columns, Nodes, lane},
    params::{Params, Solver},
};

pub(crate) fn guess(params: &Params, columns: &mut Columns) {
    let nodes = &mut columns.nodes;
    let h = f64::from(params.step);
    nodes.target = nodes.predicted.clone();
    for node in &mut nodes.target {
        node[lane::nodes::free::MASS] =
            if node[lane::nodes::free::MASS] > 0.0 { 1.0 / node[lane::nodes::free::MASS] } else { 0.0 };
    }
    nodes.free = nodes.target.clone();
    let none = vec![[0.0; 4]; nodes.predicted.len()];
    (nodes.drag, nodes.drag_moment) = (none.clone(), none);
    (nodes.touch, nodes.touch_stiffness, nodes.touch_between) = (Vec::new(), Vec::new(), Vec::new());
    for node in 0..columns.rows.nodes {
        let y = nodes.predicted[node];
        let share = f64::from(nodes.velocity[node][lane::nodes::velocity::FOLLOWED_SHARE]);
        if y[lane::nodes::predicted::INVERSE_MASS] > 0.0 && descends(params, nodes, node) {
            let lacking = h * h * (1.0 - share) * vector(nodes.acceleration[node]);
            nodes.predicted[node] = keep(y, vector(y) - lacking);
        }
    }
}

fn descends(params: &Params, nodes: &Nodes, node: usize) -> bool {
    params.sponges[nodes.sponge[node] as usize].solver == Solver::Vbd
}

/// A tet of a node: its nodes, the slot of that node, and its weight.
type Incident = ([usize; 4], usize, f64);

/// Tets of every node.
fn incidence(nodes: &Nodes) -> Vec<Vec<Incident>> {
    let mut incidence = vec![Vec::new(); nodes.position.len()];
    for (tet, weight) in nodes.topology.tets.iter().zip(&nodes.topology.weights) {
        for slot in 0..4 {
            let own = (tet.map(|node| node as usize), slot, f64::from(*weight));
            incidence[tet[slot] as usize].push(own);
        }
    }
    incidence
}

/// Columns of the deformation gradient of a tet.
fn columns_of(places: &[DVec3], tet: [usize; 4], edge: f64) -> [DVec3; 3] {
    [0, 1, 2].map(|k| (0..4).map(|slot| places[tet[slot]] * (SHAPE[slot][k] / edge)).sum())
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Elastic, damping and contact force on a node, and minus their derivative.
fn local(
    params: &Params,
    (nodes, node): (&Nodes, usize),
    places: &[DVec3],
    before: &[DVec3],
    tets: &[Incident],
) -> (DVec3, DMat3) {
    let sponge = &params.sponges[nodes.sponge[node] as usize];
    let rate = f64::from(sponge.damping) / f64::from(params.step);
    let (mut force, mut stiffness) = (DVec3::ZERO, DMat3::ZERO);
    for (tet, slot, weight) in tets {
        let (size, softer) = wetting::of_tet(sponge, nodes, *tet);
        let edge = f64::from(sponge.edge) * size;
        let [mu, lambda] = [sponge.mu, sponge.lambda].map(|constant| f64::from(constant) * softer);
        let volume = weight * edge.powi(3) / 12.0;
        let n = SHAPE[*slot].map(|shape| shape / edge);
        let f = columns_of(places, *tet, edge);
        let cofactor = [f[1].cross(f[2]), f[2].cross(f[0]), f[0].cross(f[1])];
        let ratio = f[0].dot(cofactor[0]);
        let sum = |columns: &[DVec3; 3]| -> DVec3 { (0..3).map(|k| columns[k] * n[k]).sum() };
        let slope = sum(&cofactor);
        let square: f64 = n.iter().map(|n| n * n).sum();
        let minimum = ratio.max(0.2);
        let logarithm = (1.0 / minimum) - (ratio - minimum) / (minimum * minimum);
        force -= volume * (mu * sum(&f) + ((lambda - mu) * (ratio - 1.0) - mu * logarithm) * slope);
        let bulk = lambda - mu + mu / (minimum * minimum);
        stiffness += volume * (mu * square * DMat3::IDENTITY + bulk * outer(slope, slope));
        // The viscous part: twice mu and lambda - mu times the strain since the beginning of the step.
        let g = columns_of(before, *tet, edge);
        let strain = |k: usize, l: usize| 0.5 * (g[k].dot(f[l] - g[l]) + g[l].dot(f[k] - g[k]));
        let trace = strain(0, 0) + strain(1, 1) + strain(2, 2);
        for (k, n) in n.iter().enumerate() {
            for (l, g) in g.iter().enumerate() {
                let bulk = if k == l { (lambda - mu) * trace } else { 0.0 };
                force -= volume * rate * n * (2.0 * mu * strain(k, l) + bulk) * *g;
            }
        }
        let all = g.iter().map(|g| outer(*g, *g)).fold(DMat3::ZERO, |sum, g| sum + g);
        stiffness += volume * rate * (mu * square * all + lambda * outer(sum(&g), sum(&g)));
    }
    touch::add(nodes, node, (&mut force, &mut stiffness));
    (force, stiffness)
}

/// Minimum of the energy without obstacles, and the stiffness with inertia.
fn minimum(
    params: &Params,
    nodes: &Nodes,
    node: usize,
    (places, before): (&[DVec3], &[DVec3]),
    tets: &[Incident],
) -> (DVec3, DMat3) {
    let (force, stiffness) = local(params, (nodes, node), places, before, tets);
    let h = f64::from(params.step);
    let inertia = f64::from(nodes.target[node][lane::nodes::target::MASS]) / (h * h);
    let stiffness = stiffness + DMat3::IDENTITY * inertia;
    let pull = force + inertia * (vector(nodes.target[node]) - places[node]);
    (places[node] + stiffness.inverse() * pull, stiffness)
}

/// Moves a node out of all obstacles, out of walls twice; returns the forces on it by bodies, and by the walls last.
fn push(
    params: &Params,
    columns: &Columns,
    node: usize,
    stiffness: DMat3,
    point: &mut DVec3,
) -> (Vec<DVec3>, DVec3) {
    let h = f64::from(params.step);
    let old = vector(columns.nodes.position[node]);
    let friction = f64::from(params.sponges[columns.nodes.sponge[node] as usize].friction);
    let mut by_walls = push_by_walls(params, stiffness, friction, old, point);
    let mut by_bodies = Vec::new();
    let bodies = &columns.bodies.states.0;
    let pieces = obstacles::convex(bodies);
    for (index, body) in bodies.iter().enumerate() {
        let mut force = DVec3::ZERO;
        for (_, piece) in pieces.iter().filter(|(of, _)| *of == index && body.touches_nodes) {
            let drift = h * shapes::velocity(body, *point);
            let clearance = 1e-3 * f64::from(params.sponges[columns.nodes.sponge[node] as usize].edge);
            let (distance, beyond, normal) = obstacles::met(piece, clearance, old, *point - drift);
            let (depth, slide) = (-(distance + beyond), *point - old - drift);
            force += react(stiffness, depth, normal, slide, f64::from(body.friction), point);
        }
        by_bodies.push(force);
    }
    by_walls += push_by_walls(params, stiffness, 0.0, old, point);
    if let Some((low, high)) = params.walls {
        *point = point.clamp(low.as_dvec3(), high.as_dvec3());
    }
    (by_bodies, by_walls)
}

fn push_by_walls(params: &Params, stiffness: DMat3, friction: f64, old: DVec3, point: &mut DVec3) -> DVec3 {
    let mut force = DVec3::ZERO;
    let Some((low, high)) = params.walls else { return force };
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for (normal, wall) in [(axis, low), (-axis, high)] {
            let depth = (wall.as_dvec3() - *point).dot(normal);
            let slide = *point - old;
            force += react(stiffness, depth, normal, slide, friction, point);
        }
    }
    force
}

fn react(
    stiffness: DMat3,
    depth: f64,
    normal: DVec3,
    slide: DVec3,
    friction: f64,
    point: &mut DVec3,
) -> DVec3 {
    if depth <= 0.0 {
        return DVec3::ZERO;
    }
    let tangential = slide - slide.dot(normal) * normal;
    let back = depth * normal - tangential;
    let stuck = stiffness * back;
    let across = stuck.dot(normal);
    let along = stuck - across * normal;
    if along.length() <= friction * across {
        *point += back;
        return stuck;
    }
    let compliance = stiffness.inverse();
    let slanted = normal + friction * along.normalize_or_zero();
    let minimum = 0.1 * normal.dot(compliance * normal);
    let direction = if normal.dot(compliance * slanted) > minimum { slanted } else { normal };
    let size = depth / normal.dot(compliance * direction);
    *point += size * (compliance * direction);
    size * direction
}

/// Over-relaxation of a node: three tenths beyond its minimum, in steps of more than one sweep. It falls to none where the
/// volume of a tet is off by half, or the way is a tenth of an edge.
fn relaxation(
    params: &Params,
    (nodes, node): (&Nodes, usize),
    places: &[DVec3],
    tets: &[Incident],
    way: DVec3,
) -> f64 {
    let sponge = &params.sponges[nodes.sponge[node] as usize];
    let (mut force, mut stiffness) = (DVec3::ZERO, DMat3::ZERO);
    let touches = touch::add(nodes, node, (&mut force, &mut stiffness));
    if sponge.iterations < 2 || touches {
        return 1.0;
    }
    let volume = |(tet, ..): &Incident| {
        let (size, _) = wetting::of_tet(sponge, nodes, *tet);
        let f = columns_of(places, *tet, f64::from(sponge.edge) * size);
        f[0].dot(f[1].cross(f[2]))
    };
    let strain = tets.iter().map(|tet| (volume(tet) - 1.0).abs()).fold(0.0, f64::max);
    let short = (0.01 - way.length_squared() / f64::from(sponge.edge).powi(2)) / 0.0075;
    1.0 + 0.3 * ((0.5 - strain) / 0.3).min(short).clamp(0.0, 1.0)
}

pub(crate) fn vbd(params: &Params, columns: &mut Columns) {
    let incidence = incidence(&columns.nodes);
    let before: Vec<DVec3> = columns.nodes.position.iter().map(|row| vector(*row)).collect();
    let mut places: Vec<DVec3> = columns.nodes.predicted.iter().map(|row| vector(*row)).collect();
    // Rows are in the order of the colours, and nodes of a colour are independent.
    for node in 0..columns.rows.nodes {
        if columns.nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS] > 0.0
            && descends(params, &columns.nodes, node)
        {
            let at = (&places[..], &before[..]);
            let (mut point, stiffness) = minimum(params, &columns.nodes, node, at, &incidence[node]);
            let way = point - places[node];
            let further = relaxation(params, (&columns.nodes, node), &places, &incidence[node], way);
            let relaxed = places[node] + way * further;
            let mut end = relaxed;
            push(params, columns, node, stiffness, &mut end);
            if end != relaxed {
                push(params, columns, node, stiffness, &mut point);
                end = point;
            }
            places[node] = end;
        }
    }
    let rows = columns.rows.nodes;
    for (predicted, place) in columns.nodes.predicted[..rows].iter_mut().zip(places) {
        *predicted = keep(*predicted, place);
    }
}

/// Whether a node may have come within a hundredth of an edge of an obstacle on its path.
fn is_near(params: &Params, columns: &Columns, node: usize, point: DVec3) -> bool {
    let margin = 0.01 * f64::from(params.sponges[columns.nodes.sponge[node] as usize].edge);
    let walls = params.walls.is_some_and(|(low, high)| {
        (point - low.as_dvec3()).min_element().min((high.as_dvec3() - point).min_element()) < margin
    });
    let bodies = columns.bodies.states.0.iter().filter(|body| body.touches_nodes);
    let old = vector(columns.nodes.position[node]);
    walls
        || bodies.into_iter().any(|body| {
            let drift = f64::from(params.step) * shapes::velocity(body, point);
            shapes::distance(body, old).0 - (point - drift - old).length() < margin
        })
}

/// Wrenches on every body so far.
fn joined_wrenches(bodies: &BodyStore) -> Vec<Wrench> {
    let count = bodies.states.0.len();
    let mut wrenches = vec![Wrench::default(); count];
    for chunk in bodies.node_wrenches.0.chunks(count.max(1)) {
        for (wrench, part) in wrenches.iter_mut().zip(chunk) {
            wrench.impulse += part.impulse;
            wrench.angular_impulse += part.angular_impulse;
        }
    }
    wrenches
}

/// The body nearest to a position at the end of the step, if it is within a distance.
fn touched(bodies: &[Body], place: DVec3, h: f64, near: f64) -> Option<usize> {
    let away = |body: &Body| shapes::distance(body, place - h * shapes::velocity(body, place)).0;
    let found = bodies.iter().enumerate().filter(|(_, body)| body.touches_nodes);
    let found = found.map(|(index, body)| (index, away(body))).filter(|(_, away)| *away < near);
    found.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

pub(crate) fn reaction(params: &Params, columns: &mut Columns) {
    let h = f64::from(params.step);
    let incidence = incidence(&columns.nodes);
    let before: Vec<DVec3> = columns.nodes.position.iter().map(|row| vector(*row)).collect();
    let places: Vec<DVec3> = columns.nodes.predicted.iter().map(|row| vector(*row)).collect();
    let mut wrenches = joined_wrenches(&columns.bodies);
    let mut reaction = vec![[0.0; 4]; columns.nodes.position.len()];
    for node in 0..columns.rows.nodes {
        if !descends(params, &columns.nodes, node) {
            continue;
        }
        let (force, stiffness) = local(params, (&columns.nodes, node), &places, &before, &incidence[node]);
        let resists = -h * h / 3.0 * (stiffness.x_axis.x + stiffness.y_axis.y + stiffness.z_axis.z);
        let w = f64::from(columns.nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
        if w <= 0.0 {
            reaction[node] = row(-h * force, resists);
            continue;
        }
        reaction[node] = row(DVec3::ZERO, 1.0 / w);
        if is_near(params, columns, node, places[node]) {
            let at = (&places[..], &before[..]);
            let (mut point, stiffness) = minimum(params, &columns.nodes, node, at, &incidence[node]);
            let (by_bodies, by_walls) = push(params, columns, node, stiffness, &mut point);
            for (body, force) in by_bodies.iter().enumerate() {
                let centre = columns.bodies.states.0[body].state.position.as_dvec3();
                wrenches[body].add(-h * *force, before[node] - centre);
            }
            let all = by_walls + by_bodies.into_iter().sum::<DVec3>();
            if all != DVec3::ZERO {
                reaction[node] = row(h * all, resists);
            }
        }
    }
    columns.nodes.reaction = reaction;
    columns.bodies.node_wrenches.0 = wrenches;
}

pub(crate) fn momentum(params: &Params, columns: &mut Columns) {
    let h = f64::from(params.step);
    let (nodes, bodies) = (&mut columns.nodes, &columns.bodies.states.0);
    let mut wrenches = joined_wrenches(&columns.bodies);
    let joined = touch::joined(nodes, params.sponges.len());
    for (index, sponge) in params.sponges.iter().enumerate() {
        if sponge.solver != Solver::Vbd || joined[index][0] != index {
            continue;
        }
        // Sponges in contact are corrected together.
        let is_own = |node: &usize| joined[index].contains(&(nodes.sponge[*node] as usize));
        let own: Vec<usize> = (0..columns.rows.nodes).filter(is_own).collect();
        let weight = |node: usize| match f64::from(nodes.reaction[node][lane::nodes::reaction::MASS]) {
            weight if weight > 0.0 => weight + f64::from(nodes.drag[node][lane::nodes::drag::MASS]),
            weight => -weight,
        };
        let mass: f64 = own.iter().map(|node| weight(*node)).sum();
        let centre =
            own.iter().map(|node| weight(*node) * vector(nodes.position[*node])).sum::<DVec3>() / mass;
        let (mut lacking, mut moment, mut inertia) = (DVec3::ZERO, DVec3::ZERO, DMat3::ZERO);
        for node in own.iter().copied() {
            let arm = vector(nodes.position[node]) - centre;
            let w = f64::from(nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
            let gained = vector(nodes.predicted[node]) - vector(nodes.free[node]);
            let own = if w > 0.0 { gained / (w * h) } else { DVec3::ZERO };
            let of_fluid = |row: [f32; 4]| if w > 0.0 { vector(row) } else { DVec3::ZERO };
            let own = vector(nodes.reaction[node]) + of_fluid(nodes.drag[node]) - own;
            lacking += own;
            moment += arm.cross(own) + of_fluid(nodes.drag_moment[node]);
            inertia += weight(node) * (DMat3::IDENTITY * arm.length_squared() - outer(arm, arm));
        }
        let turn = inertia.inverse() * moment;
        for node in own {
            let (x, y, v) = (nodes.position[node], nodes.predicted[node], nodes.velocity[node]);
            let w = f64::from(y[lane::nodes::predicted::INVERSE_MASS]);
            let change = lacking / mass + turn.cross(vector(x) - centre);
            let resists = -f64::from(nodes.reaction[node][lane::nodes::reaction::MASS]);
            if resists > 0.0 {
                nodes.reaction[node] = row(vector(nodes.reaction[node]) - resists * change, -resists);
            }
            if w <= 0.0 {
                continue;
            }
            let mut place = vector(y);
            if resists > 0.0 {
                let near = 1.0e-2 * f64::from(params.sponges[nodes.sponge[node] as usize].edge);
                if let Some(body) = touched(bodies, place, h, near) {
                    wrenches[body].add(resists * change, vector(x) - bodies[body].state.position.as_dvec3());
                }
            } else {
                place += h * change;
                if let Some((low, high)) = params.walls {
                    place = place.max(low.as_dvec3()).min(high.as_dvec3());
                }
            }
            nodes.predicted[node] = row(place, w);
            let a = vector(nodes.acceleration[node]);
            let gained = (place - vector(x)) / h - vector(v);
            nodes.velocity[node][lane::nodes::velocity::FOLLOWED_SHARE] =
                (gained.dot(a) / (h * a.length_squared())).clamp(0.0, 1.0) as f32;
        }
    }
    columns.bodies.node_wrenches.0 = wrenches;
}
