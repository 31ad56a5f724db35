// Sponges that may touch, and pairs of nodes; `pairs.rs` has the formulas. Used with the binding `sponges`.

struct Pair {
    normal: vec3<f32>,
    facing: f32,
    gap: f32,
    aside: f32,
}

fn may_meet(a: u32, b: u32) -> bool {
    let own = sponges.all[a];
    return own.solver == SOLVER_VBD && sponges.all[b].solver == SOLVER_VBD && (a != b || own.self_contact != 0u);
}

fn contact_edge(sponge: u32) -> f32 {
    return sponges.all[sponge].edge * (1.0 + sponges.all[sponge].wetting.swelling);
}

// `facing` is at most zero where the surfaces do not face each other; the other values are then invalid.
fn pair_of(a: vec3<f32>, b: vec3<f32>, normal_a: vec3<f32>, normal_b: vec3<f32>) -> Pair {
    let weight_a = sqrt(dot(normal_a, normal_a));
    let weight_b = sqrt(dot(normal_b, normal_b));
    let minimum = MINIMUM_FACING + RIM_FACING * (1.0 - max(weight_a, weight_b));
    let facing = -dot(normal_a, normal_b) / (weight_a * weight_b) - minimum;
    let towards = normal_b - normal_a;
    let normal = towards / sqrt(dot(towards, towards));
    let apart = a - b;
    let gap = dot(normal, apart);
    return Pair(normal, facing, gap, dot(apart, apart) - gap * gap);
}

// How squarely the two face each other, 0 to 1.
fn opposition(pair: Pair) -> f32 {
    return min(pair.facing / FACING_RANGE, 1.0);
}

// Weight of the pair by the distance along the surface.
fn share(pair: Pair, edge: f32) -> f32 {
    let reach = PAIR_REACH * edge;
    let closeness = max(1.0 - pair.aside / (reach * reach), 0.0);
    return 3.0 / PI / (reach * reach) * closeness * closeness;
}
