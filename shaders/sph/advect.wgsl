// #include wrap
// Second half of semi-implicit Euler: x <- x + h v, kept inside the walls and wrapped along periodic axes. Then the largest speed, and the
// first row that is not finite. Writes the particles to the columns that the next step sorts.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_id: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_position_next: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_velocity_next: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_id_next: array<u32>;
@group(0) @binding(8) var<storage, read_write> extremes: array<atomic<u32>>;

var<workgroup> largest: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    if (lane == 0u) {
        atomicStore(&largest, 0u);
    }
    workgroupBarrier();
    if (row < params.fluid_rows) {
        let own = fluid_position[row];
        let its_velocity = fluid_velocity[row];
        var v = its_velocity.xyz;
        var x = own.xyz + clock.step * v;
        if (params.has_walls != 0u) {
            let margin = params.spacing * WALL_MARGIN;
            let low = params.wall_low + margin;
            let high = params.wall_high - margin;
            v = select(v, max(v, vec3<f32>(0.0)), x < low);
            v = select(v, min(v, vec3<f32>(0.0)), x > high);
            x = select(select(x, high, x > high), low, x < low);
        }
        if (params.has_periods != 0u) {
            x = wrapped_into_box(x);
        }
        fluid_position_next[row] = with_vector(own, x);
        fluid_velocity_next[row] = with_vector(its_velocity, v);
        fluid_id_next[row] = fluid_id[row];
        let square = dot(v, v);
        if (is_finite(square) && is_finite(x.x + x.y + x.z)) {
            atomicMax(&largest, bitcast<u32>(square));
        } else {
            atomicMax(&extremes[EXTREME_FLUID_ROW], 0xffffffffu - row);
        }
    }
    workgroupBarrier();
    if (lane == 0u) {
        atomicMax(&extremes[EXTREME_FLUID_SPEED], atomicLoad(&largest));
    }
}
