// #include smoothing, images, image, shares
// Moments of the neighbourhoods with the images, and the divergence that errors of the density ask for; `moments.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(6) var<storage, read_write> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_moment: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_factors: array<vec4<f32>>;

// Inverse of the second moment, of one between it and that of a lattice where they are far apart.
struct Inverse {
    along: vec3<f32>,
    between: vec3<f32>,
}

fn inverse_of(second_along: vec3<f32>, second_between: vec3<f32>) -> Inverse {
    let scale = 1.0 / params.lattice_moment;
    let along = second_along * scale - 1.0;
    let between = second_between * scale;
    let norm = sqrt(dot(along, along) + 2.0 * dot(between, between));
    let part = select(1.0, MAXIMUM_DEVIATION / norm, norm > MAXIMUM_DEVIATION);
    let a = along * part + 1.0;
    let b = between * part;
    let minors = a.yzx * a.zxy - b * b;
    let others = b.yzx * b.zxy - a * b;
    let determinant = a.x * minors.x + b.z * others.z + b.y * others.y;
    return Inverse(minors * (scale / determinant), others * (scale / determinant));
}

fn target_of(density: f32, moment: vec3<f32>, material: f32) -> f32 {
    let share = sqrt(dot(moment, moment)) / params.surface_moment - SURFACE_BEGIN;
    let lack = max(share * (1.0 / (1.0 - SURFACE_BEGIN)), 0.0) * params.surface_lack;
    let error = density + lack - 1.0;
    let is_in_pores = material > MINIMUM_MATERIAL;
    let dead_zone = select(DEAD_ZONE, DEAD_ZONE_IN_PORES, is_in_pores);
    let slow = min(clock.step / CORRECTION_TIME_IN_PORES, 1.0 / CORRECTION_STEPS);
    let part = select(1.0 / CORRECTION_STEPS, slow, is_in_pores);
    let size = clamp(abs(error) - dead_zone, 0.0, MAXIMUM_ERROR) * part;
    return select(-size, size, error > 0.0);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    let point = fluid_position[row].xyz;
    var first = vec3<f32>(0.0);
    var along = vec3<f32>(0.0);
    var between = vec3<f32>(0.0);
    var shapes = 0.0;
    // Of `c^2 e e^T`.
    var squares = vec3<f32>(0.0);
    var squares_between = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let offset = -apart_from(point, fluid_position[other].xyz);
        let push = pair_factor(offset) * offset;
        first += push;
        along += push * offset;
        between += push.yzx * offset.zxy;
        squares += push * push;
        squares_between += push.yzx * push.zxy;
        shapes += shape(closeness(params.smoothing, dot(offset, offset)));
    }
    let seen = fluid_near_images[row];
    for (var k = share.first; k < seen; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let there = image_position[other];
        let offset = -apart_from(point, there.xyz);
        let push = (there[IMAGE_RATIO] * pair_factor(offset)) * offset;
        first += push;
        along += push * offset;
        between += push.yzx * offset.zxy;
        squares += push * push;
        squares_between += push.yzx * push.zxy;
        shapes += there[IMAGE_RATIO] * shape(closeness(params.smoothing, dot(offset, offset)));
    }
    let all_first = share_sum(lane, vec4<f32>(first, shapes));
    first = all_first.xyz;
    shapes = all_first.w;
    along = share_sum3(lane, along);
    between = share_sum3(lane, between);
    squares = share_sum3(lane, squares);
    squares_between = share_sum3(lane, squares_between);
    if (!share.writes) {
        return;
    }
    let volume = params.particle_mass / params.rest_density;
    // Beginning with the material of sponges.
    let material = fluid_moment[row];
    first += material.xyz;
    along += fluid_renormalisation[row].xyz;
    between += fluid_renormalisation_between[row].xyz;
    let density = shapes * (params.smoothing.value * volume) + material[FLUID_MOMENT_MATERIAL];
    let inverse = inverse_of(along, between);
    // The square of the inverse, contracted with those.
    let a = inverse.along;
    let b = inverse.between;
    let x = vec3<f32>(a.x, b.z, b.y);
    let y = vec3<f32>(b.z, a.y, b.x);
    let z = vec3<f32>(b.y, b.x, a.z);
    let on = vec3<f32>(dot(x, x), dot(y, y), dot(z, z));
    let off = vec3<f32>(dot(y, z), dot(z, x), dot(x, y));
    let all = dot(on, squares) + 2.0 * dot(off, squares_between);
    fluid_renormalisation[row] = vec4<f32>(inverse.along, density);
    // Beside it what `diagonal.wgsl` begins with.
    fluid_renormalisation_between[row] = vec4<f32>(inverse.between, all);
    fluid_moment[row] = vec4<f32>(first, material[FLUID_MOMENT_MATERIAL]);
    let asked = target_of(density, first, material[FLUID_MOMENT_MATERIAL]);
    fluid_factors[row] = vec4<f32>(-symmetric_times(inverse.along, inverse.between, first), asked);
}
