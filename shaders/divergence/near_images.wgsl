// #include grid, shares, ball
// For every particle, the images within the support radius; the list has the layout of `fluid_neighbors.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> starts: array<u32>;
@group(0) @binding(6) var<storage, read> image_order: array<u32>;
@group(0) @binding(7) var<storage, read_write> fluid_near_images: array<u32>;
@group(0) @binding(8) var<storage, read_write> extremes: array<atomic<u32>>;

var<private> list_row: u32;

fn visit_run(point: vec3<f32>, begin: u32, end: u32) {
    let radius = params.smoothing.support_radius;
    for (var place = begin; place < end; place += 1u) {
        let image = image_order[place];
        let apart = point - points[image].xyz;
        if (dot(apart, apart) < radius * radius) {
            if (found < params.near_image_capacity) {
                fluid_near_images[list_row + (found + 1u) * params.fluid_rows] = image;
            }
            found += 1u;
        }
    }
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
    let share = shared_row(group, groups, lane, params.fluid_rows);
    let capacity = params.near_image_capacity;
    list_row = share.row;
    let length = find(share, lane, fluid_position[share.row].xyz, params.smoothing.support_radius, capacity);
    if (share.is_last) {
        fluid_near_images[share.row] = length;
        if (length > capacity) {
            atomicMax(&extremes[EXTREME_NEAR_IMAGES], length);
        }
    }
}
