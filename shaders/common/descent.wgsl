// The energy of one node while all others are fixed, and its obstacles; `descent.rs` and `obstacles.rs` have the formulas.
// Uses the bindings `params`, `node_stars`, `node_position`, `node_predicted`, and `bodies`.

struct Local {
    force: vec3<f32>,
    stiffness: mat3x3<f32>,
    // The largest volume change of a tet, of either sign, over the volume at rest.
    strain: f32,
}

struct Quadratic {
    way: vec3<f32>,
    stiffness: mat3x3<f32>,
    inverse: mat3x3<f32>,
}

struct Reaction {
    change: vec3<f32>,
    force: vec3<f32>,
}

fn outer(a: vec3<f32>, b: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(a * b.x, a * b.y, a * b.z);
}

fn inverse_of(matrix: mat3x3<f32>) -> mat3x3<f32> {
    // Divided by its trace: the determinant of stiff material in short steps would overflow.
    let small = 1.0 / (matrix[0].x + matrix[1].y + matrix[2].z);
    let m = matrix * small;
    let a = cross(m[1], m[2]);
    let b = cross(m[2], m[0]);
    let c = cross(m[0], m[1]);
    let scale = small / dot(m[0], a);
    return mat3x3<f32>(a * scale, b * scale, c * scale);
}

fn diagonal(value: f32) -> mat3x3<f32> {
    return mat3x3<f32>(vec3<f32>(value, 0.0, 0.0), vec3<f32>(0.0, value, 0.0), vec3<f32>(0.0, 0.0, value));
}

// Viscous force of one tet, from the columns of its deformation now and before, times the edge.
fn viscosity(f: mat3x3<f32>, g: mat3x3<f32>, sponge: Sponge, rate: f32) -> Local {
    let shear = sponge.edge * sponge.mu / 12.0;
    let volume = sponge.edge * sponge.lambda / 12.0;
    let inverse_square = 1.0 / (sponge.edge * sponge.edge);
    let d = f - g;
    let scale = 0.5 * inverse_square;
    let dd = 2.0 * dot(g[0], d[0]) * scale;
    let ee = 2.0 * dot(g[1], d[1]) * scale;
    let ff = 2.0 * dot(g[2], d[2]) * scale;
    let de = (dot(g[0], d[1]) + dot(g[1], d[0])) * scale * 2.0 * shear;
    let df = (dot(g[0], d[2]) + dot(g[2], d[0])) * scale * 2.0 * shear;
    let ef = (dot(g[1], d[2]) + dot(g[2], d[1])) * scale * 2.0 * shear;
    let trace = (dd + ee + ff) * (volume - shear);
    let first = g[0] * ((dd * 2.0 * shear + trace + df) * rate);
    let second = g[1] * ((de + ef) * rate);
    let third = g[2] * ((ff * 2.0 * shear + trace + df) * rate);
    let n = g[0] + g[2];
    var stiffness = outer(n * (rate * inverse_square * volume), n);
    let both = rate * inverse_square * 2.0 * shear;
    stiffness += outer(g[0] * both, g[0]) + outer(g[1] * both, g[1]) + outer(g[2] * both, g[2]);
    return Local(first + second + third, stiffness, 0.0);
}

fn columns_of(x: vec3<f32>, u: vec3<f32>, q: vec3<f32>, r: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(u - x, q - r, (q + r) - (x + u));
}

fn wetness_of(row: u32) -> f32 {
    return bitcast<f32>(node_stars[row * STAR_WORDS + STAR_WETNESS]);
}

// Contact force of a node, its stiffness along the axes and between them, from behind the stars.
fn touch_of(row: u32) -> array<vec3<f32>, 3> {
    let base = params.node_rows * STAR_WORDS + row * TOUCH_WORDS;
    var all = array<vec3<f32>, 3>();
    for (var k = 0u; k < 3u; k += 1u) {
        let first = base + 3u * k;
        let words = vec3<u32>(node_stars[first], node_stars[first + 1u], node_stars[first + 2u]);
        all[k] = bitcast<vec3<f32>>(words);
    }
    return all;
}

// Force on a node at `x` by its material and its contacts, and its stiffness.
fn local_energy(row: u32, x: vec3<f32>, old: vec3<f32>, sponge: Sponge, step: f32) -> Local {
    return with_touch(row, material_energy(row, x, old, sponge, step, 0u, 1u));
}

// The part of the material, by every `stride`-th of the directions from `first` on.
fn material_energy(
    row: u32,
    x: vec3<f32>,
    old: vec3<f32>,
    sponge: Sponge,
    step: f32,
    first: u32,
    stride: u32,
) -> Local {
    let base = row * STAR_WORDS;
    let tets = node_stars[base + STAR_TETS];
    let weights = node_stars[base + STAR_WEIGHTS];
    let dry_shear = sponge.edge * sponge.mu / 12.0;
    let dry_volume = sponge.edge * sponge.lambda / 12.0;
    let dry_rate = sponge.damping / step;
    let becomes_wet = sponge.wetting.softening > 0.0 || sponge.wetting.swelling > 0.0;
    // Of a tet, which is as wet as its nodes on average; `wetted.rs` has the formulas.
    var edge = sponge.edge;
    var inverse_edge = 1.0 / edge;
    var shear = dry_shear;
    var volume = dry_volume;
    var rate = dry_rate;
    var rings = RINGS;
    var pull = vec3<f32>(0.0);
    var count = 0.0;
    var pressure = vec3<f32>(0.0);
    var stiffness = mat3x3<f32>();
    var damping = Local(vec3<f32>(0.0), mat3x3<f32>(), 0.0);
    var strain = 0.0;
    for (var direction = first; direction < DIRECTIONS; direction += stride) {
        let ring = rings[direction];
        let partner = node_stars[base + STAR_DIRECTIONS + direction];
        let u = node_predicted[partner].xyz;
        for (var k = 0u; k < 4u; k += 1u) {
            let tet = 4u * direction + k;
            if (((tets >> tet) & 1u) == 0u) {
                continue;
            }
            // Without a table all weights are 1.
            var weight = 1.0;
            if (weights != 0u) {
                weight = bitcast<f32>(node_stars[weights + tet]);
            }
            let r_row = node_stars[base + ring[k]];
            let q_row = node_stars[base + ring[(k + 1u) % 4u]];
            let r = node_predicted[r_row].xyz;
            let q = node_predicted[q_row].xyz;
            if (becomes_wet) {
                let all = wetness_of(row) + wetness_of(partner) + (wetness_of(q_row) + wetness_of(r_row));
                let size = 1.0 + sponge.wetting.swelling * (0.25 * all);
                let softer = 1.0 - sponge.wetting.softening * (0.25 * all);
                edge = sponge.edge * size;
                inverse_edge = 1.0 / edge;
                shear = dry_shear * (size * softer);
                volume = dry_volume * (size * softer);
                rate = dry_rate * (softer / size);
            }
            let lame = volume - shear;
            pull += ((q - x) + (r - x)) * (shear * weight);
            count += 2.0 * shear * weight;
            let area = cross(q - u, r - u) * (2.0 * inverse_edge * inverse_edge);
            let ratio = dot(u - x, area) * inverse_edge;
            strain = max(strain, abs(ratio - 1.0));
            let inverse = 1.0 / max(ratio, POLYNOMIAL_RATIO);
            let slope = lame * (ratio - 1.0) - shear * inverse * (2.0 - ratio * inverse);
            let own = area * weight;
            pressure += own * (slope * edge);
            stiffness += outer(own * (lame + shear * inverse * inverse), area);
            if (rate > 0.0) {
                let f = columns_of(x, u, q, r);
                let g = columns_of(old, node_position[partner].xyz, node_position[q_row].xyz, node_position[r_row].xyz);
                let part = viscosity(f, g, sponge, rate * weight);
                damping.force += part.force;
                damping.stiffness += part.stiffness;
            }
        }
    }
    return Local(pull + pressure + damping.force, stiffness + diagonal(count) + damping.stiffness, strain);
}

// With the contacts.
fn with_touch(row: u32, material: Local) -> Local {
    var local = material;
    if (params.pair_radius > 0.0) {
        let touch = touch_of(row);
        local.force += touch[0];
        local.stiffness += mat3x3<f32>(
            vec3<f32>(touch[1].x, touch[2].x, touch[2].y),
            vec3<f32>(touch[2].x, touch[1].y, touch[2].z),
            vec3<f32>(touch[2].y, touch[2].z, touch[1].z),
        );
        // A node in contact moves to its minimum, without over-relaxation.
        local.strain += select(0.0, 1.0, touch[1].x + touch[1].y + touch[1].z > 0.0);
    }
    return local;
}

// The way to the minimum of the energy without obstacles.
fn minimum(local: Local, x: vec3<f32>, node_target: vec4<f32>, step: f32) -> Quadratic {
    let inertia = node_target[NODE_TARGET_MASS] / (step * step);
    let stiffness = local.stiffness + diagonal(inertia);
    let inverse = inverse_of(stiffness);
    return Quadratic(inverse * (local.force + (node_target.xyz - x) * inertia), stiffness, inverse);
}

fn react(quadratic: Quadratic, depth: f32, normal: vec3<f32>, slide: vec3<f32>, friction: f32) -> Reaction {
    let back = normal * depth - (slide - normal * dot(slide, normal));
    let stuck = quadratic.stiffness * back;
    let across = dot(stuck, normal);
    let along = stuck - normal * across;
    let length = sqrt(dot(along, along));
    if (length <= across * friction) {
        return Reaction(back, stuck);
    }
    var direction = normal + along * (friction / length);
    let plain = dot(normal, quadratic.inverse * normal);
    var compliance = dot(normal, quadratic.inverse * direction);
    if (compliance <= plain * MINIMUM_COMPLIANCE) {
        direction = normal;
        compliance = plain;
    }
    let force = direction * (depth / compliance);
    return Reaction(quadratic.inverse * force, force);
}

// Contact of a point with one body, piece by piece.
fn push_by_body(
    body: Body,
    quadratic: Quadratic,
    start: vec3<f32>,
    old: vec3<f32>,
    clearance: f32,
    step: f32,
) -> Reaction {
    var point = start;
    var all = Reaction(vec3<f32>(0.0), vec3<f32>(0.0));
    for (var index = 0u; index < body.parts && body.touches_nodes != 0u; index += 1u) {
        let piece = piece_of(body, index);
        let drift = body_velocity(body, point) * step;
        // The body is at its place of the beginning of the step: so is the node, in the body's frame.
        let met = way_meets(piece, clearance, into_body(piece, old), into_body(piece, point - drift));
        let depth = -(met.distance + met.beyond);
        if (depth > 0.0) {
            let normal = out_of_body(piece, met.normal);
            let reaction = react(quadratic, depth, normal, point - old - drift, body.friction);
            point += reaction.change;
            all.change += reaction.change;
            all.force += reaction.force;
        }
    }
    return all;
}

// Position of a point after the walls, as `change` from it, and their force.
fn push_by_walls(
    low: vec3<f32>,
    high: vec3<f32>,
    quadratic: Quadratic,
    start: vec3<f32>,
    old: vec3<f32>,
    friction: f32,
) -> Reaction {
    var point = start;
    var force = vec3<f32>(0.0);
    for (var side = 0u; side < 6u; side += 1u) {
        let axis = side / 2u;
        var normal = vec3<f32>(0.0);
        var depth = 0.0;
        if (side % 2u == 0u) {
            normal[axis] = 1.0;
            depth = low[axis] - point[axis];
        } else {
            normal[axis] = -1.0;
            depth = point[axis] - high[axis];
        }
        if (depth > 0.0) {
            let reaction = react(quadratic, depth, normal, point - old, friction);
            point += reaction.change;
            force += reaction.force;
        }
    }
    return Reaction(point - start, force);
}
