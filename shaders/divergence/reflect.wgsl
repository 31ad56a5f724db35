// #include smoothing, image
// Images of vectors of the particles; w: one more than the body, 0 for none.
//
//     v_g = Q (R (v_s - u(x_s)) + u(x_b))

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> image_grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> values: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> body_states: array<Body>;
@group(0) @binding(7) var<storage, read> linear: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> angular: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_image_vectors: array<vec4<f32>>;

// A vector and its curl: velocity and angular velocity of a body, or their rates.
struct Twist {
    velocity: vec3<f32>,
    spin: vec3<f32>,
}

fn reflected(row: u32, twist: Twist) -> vec4<f32> {
    let image = images[row];
    var value = values[image.source].xyz;
    if (image.body == NO_BODY) {
        return vec4<f32>(signs_of(image) * value, 0.0);
    }
    let centre = body_states[image.body].position;
    value -= twist.velocity + cross(twist.spin, fluid_position[image.source].xyz - centre);
    value = symmetric_times(image.along, image.between, value);
    value += twist.velocity + cross(twist.spin, image.foot - centre);
    return vec4<f32>(signs_of(image) * value, f32(image.body + 1u));
}

// Of a field that bodies do not have.
@compute @workgroup_size(GROUP)
fn still(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= image_grid.rows) {
        return;
    }
    fluid_image_vectors[row] = reflected(row, Twist(vec3<f32>(0.0), vec3<f32>(0.0)));
}

// With the velocities of the bodies.
@compute @workgroup_size(GROUP)
fn moving(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= image_grid.rows) {
        return;
    }
    let body = min(images[row].body, max(params.body_rows, 1u) - 1u);
    fluid_image_vectors[row] = reflected(row, Twist(body_states[body].linear, body_states[body].angular));
}

// With vectors of the bodies that were found before.
@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= image_grid.rows) {
        return;
    }
    let body = min(images[row].body, max(params.body_rows, 1u) - 1u);
    fluid_image_vectors[row] = reflected(row, Twist(linear[body].xyz, angular[body].xyz));
}
