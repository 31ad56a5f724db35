// First half of semi-implicit Euler: v <- v + h a, and the largest acceleration.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> extremes: array<atomic<u32>>;

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
        let a = fluid_acceleration[row].xyz;
        let own = fluid_velocity[row];
        fluid_velocity[row] = with_vector(own, own.xyz + clock.step * a);
        let square = dot(a, a);
        // Bits of non-negative floats have the order of the numbers; NaN is above all.
        if (is_finite(square)) {
            atomicMax(&largest, bitcast<u32>(square));
        }
    }
    workgroupBarrier();
    if (lane == 0u) {
        atomicMax(&extremes[EXTREME_FLUID_ACCELERATION], atomicLoad(&largest));
    }
}
