// #include body, surface
// Shift towards where particles are missing, near bodies along their surfaces; `shift.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_moment: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_image_first: array<u32>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> body_states: array<Body>;
@group(0) @binding(7) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_position: array<vec4<f32>>;

// The part of a shift that leads into none of the parts of a compound.
fn beside_parts(body: Body, point: vec3<f32>, shift: vec3<f32>) -> vec3<f32> {
    var along = shift;
    for (var k = 0u; k < 2u * body.parts; k += 1u) {
        let surface = body_surface(piece_of(body, k % body.parts), point);
        let into = dot(along, surface.normal);
        if (surface.distance < SHIFT_CLEARANCE * params.spacing && into < 0.0) {
            along = select(vec3<f32>(0.0), along - into * surface.normal, k < body.parts);
        }
    }
    return along;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    if (fluid_renormalisation[row][FLUID_RENORMALISATION_DENSITY] < SPARSE) {
        return;
    }
    let own = fluid_position[row];
    let moment = fluid_moment[row].xyz;
    if (fluid_moment[row][FLUID_MOMENT_MATERIAL] > MINIMUM_MATERIAL) {
        return;
    }
    let share = max(1.0 - sqrt(dot(moment, moment)) / (SHIFT_END * params.surface_moment), 0.0);
    var shift = (-SHIFT * params.spacing * params.spacing * share) * moment;
    var last = NO_BODY;
    let end = fluid_image_first[row + 1u];
    for (var k = fluid_image_first[row]; k < end; k += 1u) {
        let body = images[k].body;
        if (body == NO_BODY || body == last) {
            continue;
        }
        last = body;
        let surface = body_surface(body_states[body], own.xyz);
        if (surface.distance < SHIFT_ALONG * params.spacing) {
            shift -= dot(shift, surface.normal) * surface.normal;
        }
        if (body_states[body].shape == SHAPE_KIND_COMPOUND) {
            shift = beside_parts(body_states[body], own.xyz, shift);
        }
    }
    let most = MAXIMUM_SHIFT * params.spacing;
    let length = sqrt(dot(shift, shift));
    if (length > most) {
        shift *= most / length;
    }
    fluid_position[row] = with_vector(own, own.xyz + shift);
}
