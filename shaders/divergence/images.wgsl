// #include body, surface, wrap, mirror, visit_images
// Images of the particles in walls and bodies, one after the other; `images.rs` has the rules.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_states: array<Body>;
@group(0) @binding(4) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_image_first: array<u32>;
@group(0) @binding(6) var<storage, read_write> image_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> images: array<Image>;

var<private> own_row: u32;

fn take_image(k: u32, position: vec3<f32>, base: Mirrored, body: u32, walls: u32) {
    let slot = fluid_image_first[own_row] + k;
    if (slot >= params.image_capacity) {
        return;
    }
    var place = position;
    if (params.has_periods != 0u) {
        place = wrapped_into_box(place);
    }
    image_position[slot] = vec4<f32>(place, base.ratio);
    images[slot] = Image(base.position, own_row, base.along, body, base.between, walls);
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
    own_row = row;
    visit_images(fluid_position[row].xyz);
}
