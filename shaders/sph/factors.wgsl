// #include smoothing, sums, roughness, images
// Coefficients of the pressure solve at the predicted positions; `factors.rs` has the formulas. The pair factors c_ij are
// computed where they are needed. `solve_begin.wgsl` sums the squared displacements.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read> fluid_boundary: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_factors: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> solve_sums: array<vec4<f32>>;

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
    let rows = params.fluid_rows;
    let is_row = row < rows;
    var displacement = 0.0;
    if (is_row) {
        let before = fluid_position[row];
        let point = fluid_predicted[row].xyz;
        let moved = point - before.xyz;
        displacement = dot(moved, moved);
        let volume = params.particle_mass / params.rest_density;
        let gradient = params.smoothing.gradient * volume;
        var own = vec3<f32>(0.0);
        var others = 0.0;
        var shapes = 0.0;
        var pairs = 0.0;
        let end = fluid_neighbors[row];
        var slot = row;
        for (var k = 0u; k < end; k += 1u) {
            slot += rows;
            let apart = apart_from(point, fluid_predicted[fluid_neighbors[slot]].xyz);
            let square = dot(apart, apart);
            let u = closeness(params.smoothing, square);
            let c = gradient * (u * u * u);
            own += c * apart;
            others += c * c * square;
            pairs += c;
            shapes += shape(u);
        }
        let wall = fluid_boundary[row];
        own -= wall.xyz;
        let minimum = params.lattice_diagonal / LATTICE_DIAGONAL_RATIO;
        // The lists hold the particle itself, which is no pair.
        let rough = (pairs - gradient) * prompt_roughness();
        let diagonal = max(dot(own, own) + others, minimum) * (clock.step * clock.step) + rough;
        let maximum = params.correction_speed * clock.step / params.spacing;
        let share = shapes * (params.smoothing.value * volume) + wall[FLUID_BOUNDARY_SHARE];
        let compression = min(share - 1.0 + fluid_acceleration[row][FLUID_ACCELERATION_ALLOWED_COMPRESSION], maximum);
        fluid_factors[row] = vec4<f32>(own, compression);
        let pressure = before[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY] * params.rest_density;
        fluid_pressure_rows[row] = vec4<f32>(pressure, 0.0, diagonal, compression);
    }
    let sum = group_row(lane, vec4<f32>(displacement, 0.0, 0.0, 0.0), false);
    let place = group_of(group, groups);
    if (lane == 0u && place * GROUP < rows) {
        solve_sums[place * SOLVE_SUM_ROWS] = sum;
    }
}
