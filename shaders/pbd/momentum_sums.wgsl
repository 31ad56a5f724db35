// #include sponges
// The rigid motion that restores the momentum of a sponge, together with those in contact with it, one workgroup per sponge;
// `momentum.rs` has the formulas. Moments are about the first node of the first of them.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<storage, read> sponge_ranges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_free: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_reaction: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> node_drag: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> node_drag_moment: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> sponge_motions: array<vec4<f32>>;

struct Sums {
    // First moment, and mass.
    first: vec4<f32>,
    // Second moments xx, yy, zz, and the mass of free nodes.
    squares: vec4<f32>,
    // Second moments xy, xz, yz.
    products: vec3<f32>,
    momentum: vec3<f32>,
    angular: vec3<f32>,
}

// Half of the threads add their own to those of the others: all of them would not fit.
var<workgroup> sums: array<Sums, SPONGE_THREADS / 2u>;

// Whether a sponge is corrected together with another.
fn is_joined(own: u32, other: u32) -> bool {
    let pair = sponge_ranges[own * RANGES + VERTEX_COLORS + other / 64u];
    let word = select(pair.x, pair.y, (other / 32u) % 2u == 1u);
    return ((word >> (other % 32u)) & 1u) != 0u;
}

fn term(row: u32, origin: vec3<f32>) -> Sums {
    let x = node_position[row].xyz - origin;
    var weight = node_reaction[row][NODE_REACTION_MASS];
    if (weight > 0.0) {
        weight += node_drag[row][NODE_DRAG_MASS];
    }
    let mass = abs(weight);
    let y = node_predicted[row];
    var lacking = node_reaction[row].xyz;
    var moment = vec3<f32>(0.0);
    if (y[NODE_PREDICTED_INVERSE_MASS] > 0.0) {
        lacking += node_drag[row].xyz - (y.xyz - node_free[row].xyz) * (clock.inverse_step / y[NODE_PREDICTED_INVERSE_MASS]);
        moment = node_drag_moment[row].xyz;
    }
    return Sums(
        vec4<f32>(x, 1.0) * mass,
        vec4<f32>(x * x * mass, max(weight, 0.0)),
        vec3<f32>(x.x * x.y, x.x * x.z, x.y * x.z) * mass,
        lacking,
        moment + cross(x, lacking),
    );
}

fn join(a: Sums, b: Sums) -> Sums {
    return Sums(
        a.first + b.first,
        a.squares + b.squares,
        a.products + b.products,
        a.momentum + b.momentum,
        a.angular + b.angular,
    );
}

@compute @workgroup_size(SPONGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u || sponges.all[group.x].solver != SOLVER_VBD) {
        return;
    }
    let none = vec3<f32>(0.0);
    var first = 0u;
    while (first < group.x && !is_joined(group.x, first)) {
        first += 1u;
    }
    let origin = node_position[sponge_ranges[first * RANGES].x].xyz;
    var own = Sums(vec4<f32>(0.0), vec4<f32>(0.0), none, none, none);
    let end = arrayLength(&sponge_ranges) / RANGES * VERTEX_COLORS;
    for (var index = first * VERTEX_COLORS; index < end; index += 1u) {
        let sponge = index / VERTEX_COLORS;
        if (sponge == group.x || is_joined(group.x, sponge)) {
            let range = sponge_ranges[sponge * RANGES + index % VERTEX_COLORS];
            for (var row = range.x + lane; row < range.y; row += SPONGE_THREADS) {
                own = join(own, term(row, origin));
            }
        }
    }
    let middle = SPONGE_THREADS / 2u;
    if (lane >= middle) {
        sums[lane - middle] = own;
    }
    workgroupBarrier();
    if (lane < middle) {
        sums[lane] = join(own, sums[lane]);
    }
    for (var half = middle / 2u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            sums[lane] = join(sums[lane], sums[lane + half]);
        }
    }
    if (lane != 0u) {
        return;
    }
    let all = sums[0];
    var centre = none;
    var velocity = none;
    var turn = none;
    if (all.squares.w > 0.0) {
        let moment = all.first.xyz;
        centre = moment / all.first.w;
        let squares = all.squares.xyz - moment * centre;
        let products = all.products - vec3<f32>(moment.x * centre.y, moment.x * centre.z, moment.y * centre.z);
        let trace = squares.x + squares.y + squares.z;
        let inertia = mat3x3<f32>(
            vec3<f32>(trace - squares.x, -products.x, -products.y),
            vec3<f32>(-products.x, trace - squares.y, -products.z),
            vec3<f32>(-products.y, -products.z, trace - squares.z),
        );
        velocity = all.momentum / all.first.w;
        let scaled = inertia * (1.0 / trace);
        let a = cross(scaled[1], scaled[2]);
        let b = cross(scaled[2], scaled[0]);
        let c = cross(scaled[0], scaled[1]);
        let determinant = dot(scaled[0], a);
        let angular = (all.angular - cross(centre, all.momentum)) / trace;
        if (determinant > MINIMUM_DETERMINANT) {
            turn = vec3<f32>(dot(a, angular), dot(b, angular), dot(c, angular)) / determinant;
        }
    }
    sponge_motions[group.x * MOTION_ROWS] = vec4<f32>(centre + origin, 0.0);
    sponge_motions[group.x * MOTION_ROWS + 1u] = vec4<f32>(velocity, 0.0);
    sponge_motions[group.x * MOTION_ROWS + 2u] = vec4<f32>(turn, 0.0);
}
