// Sums over the nodes of sponges, and the rigid motion that they ask for; `momentum.rs` has the formulas. `sponge_motions` has the
// motions, and behind them the sums over the parts of large sponges.

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

fn no_sums() -> Sums {
    let none = vec3<f32>(0.0);
    return Sums(vec4<f32>(0.0), vec4<f32>(0.0), none, none, none);
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

// The sums of all threads, in a fixed order, for the first one.
fn sum_of_group(lane: u32, own: Sums) -> Sums {
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
    return sums[0];
}

fn sponge_count() -> u32 {
    return arrayLength(&sponge_ranges) / RANGES;
}

// Parts of the nodes of every sponge, a group each.
fn part_count() -> u32 {
    let behind = arrayLength(&sponge_motions) / sponge_count() - MOTION_ROWS;
    return max(behind / SUM_ROWS, 1u);
}

// Whether a sponge is corrected together with another.
fn is_joined(own: u32, other: u32) -> bool {
    let pair = sponge_ranges[own * RANGES + VERTEX_COLORS + other / 64u];
    let word = select(pair.x, pair.y, (other / 32u) % 2u == 1u);
    return own == other || ((word >> (other % 32u)) & 1u) != 0u;
}

// The first of the sponges that are corrected together with one.
fn first_joined(own: u32) -> u32 {
    var first = 0u;
    while (first < own && !is_joined(own, first)) {
        first += 1u;
    }
    return first;
}

// Moments are about the first node of the first of the sponges that are corrected together.
fn origin_of(first: u32) -> vec3<f32> {
    return node_position[sponge_ranges[first * RANGES].x].xyz;
}

fn store_part(sponge: u32, part: u32, all: Sums) {
    let place = sponge_count() * MOTION_ROWS + (sponge * part_count() + part) * SUM_ROWS;
    sponge_motions[place] = all.first;
    sponge_motions[place + 1u] = all.squares;
    sponge_motions[place + 2u] = vec4<f32>(all.products, 0.0);
    sponge_motions[place + 3u] = vec4<f32>(all.momentum, 0.0);
    sponge_motions[place + 4u] = vec4<f32>(all.angular, 0.0);
}

fn part_of(sponge: u32, part: u32) -> Sums {
    let place = sponge_count() * MOTION_ROWS + (sponge * part_count() + part) * SUM_ROWS;
    return Sums(
        sponge_motions[place],
        sponge_motions[place + 1u],
        sponge_motions[place + 2u].xyz,
        sponge_motions[place + 3u].xyz,
        sponge_motions[place + 4u].xyz,
    );
}

// Centre, velocity and angular velocity that restore the momentum.
fn store_motion(sponge: u32, origin: vec3<f32>, all: Sums) {
    let none = vec3<f32>(0.0);
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
    sponge_motions[sponge * MOTION_ROWS] = vec4<f32>(centre + origin, 0.0);
    sponge_motions[sponge * MOTION_ROWS + 1u] = vec4<f32>(velocity, 0.0);
    sponge_motions[sponge * MOTION_ROWS + 2u] = vec4<f32>(turn, 0.0);
}
