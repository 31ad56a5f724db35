// #include smoothing, drag, solid_mirrors, image
// Velocities with the drag, and the material that flows past them; `solid_velocity.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_mobility: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> control_solved: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let end = fluid_controls[row];
    if (end == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let point = fluid_position[row].xyz;
    var slot = row;
    let near = walls_near(point);
    let mirrors = select(1u, MIRRORS, near != 0u);
    var sum = vec3<f32>(0.0);
    var interior = 0.0;
    var moment = vec3<f32>(0.0);
    var on = vec3<f32>(0.0);
    var off = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_controls[slot];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there.w * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        let node = control_solved[other];
        sum += weight * node.xyz;
        interior += weight;
        for (var mirror = 0u; mirror < mirrors; mirror += 1u) {
            let image = mirrored(near, mirror, there.xyz);
            if (!image.is_there) {
                continue;
            }
            let offset = point - image.position;
            let u = closeness(params.solid, dot(offset, offset));
            let apart = (node.w * (u * u * u)) * offset;
            let v = image.signs * node.xyz;
            moment += apart;
            on += v * apart;
            off += v.yzx * apart.zxy + v.zxy * apart.yzx;
        }
    }
    let mobility = fluid_mobility[row].x;
    let own = mobility * fluid_correction[row].xyz + ((1.0 - mobility) * weight_inside(interior)) * sum;
    on -= own * moment;
    off -= own.yzx * moment.zxy + own.zxy * moment.yzx;
    let rate = dot(on, fluid_renormalisation[row].xyz) + dot(off, fluid_renormalisation_between[row].xyz);
    fluid_correction[row] = vec4<f32>(own, rate * params.solid.gradient);
}
