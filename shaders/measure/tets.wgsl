// #include sponges, sums, partial_sums
// Sums of the measures over the tets, per workgroup. a: volume, elastic energy of the solver of the sponge.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<storage, read> tets: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> tet_sponge: array<u32>;
@group(0) @binding(4) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> partial_sums: array<GroupSums>;
@group(0) @binding(6) var<storage, read> node_wetting: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> tet_weight: array<f32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    var own = no_sums();
    if (row < params.tet_rows) {
        var sponge = sponges.all[tet_sponge[row]];
        let solver = sponge.solver & ~ASLEEP;
        let tet = tets[row];
        if (sponge.wetting.softening > 0.0 || sponge.wetting.swelling > 0.0) {
            // As `wetted.rs` has it.
            let two = vec2<f32>(node_wetting[tet.x][NODE_WETTING_WETNESS], node_wetting[tet.y][NODE_WETTING_WETNESS]);
            let others = vec2<f32>(node_wetting[tet.z][NODE_WETTING_WETNESS], node_wetting[tet.w][NODE_WETTING_WETNESS]);
            let wetness = 0.25 * dot(two + others, vec2<f32>(1.0));
            sponge.edge *= 1.0 + sponge.wetting.swelling * wetness;
            sponge.mu *= 1.0 - sponge.wetting.softening * wetness;
            sponge.lambda *= 1.0 - sponge.wetting.softening * wetness;
        }
        let p0 = node_position[tet.x].xyz;
        let p1 = node_position[tet.y].xyz;
        let p2 = node_position[tet.z].xyz;
        let p3 = node_position[tet.w].xyz;
        let d = (p1 - p0) / sponge.edge;
        let e = (p2 - p3) / sponge.edge;
        let f = ((p2 - p0) + (p3 - p1)) / sponge.edge;
        let ratio = dot(d, cross(e, f));
        let lengths = vec3<f32>(length(d), length(e), length(f)) - 1.0;
        let shears = vec3<f32>(dot(d, e), dot(d, f), dot(e, f));
        let volume = sponge.edge * sponge.edge * sponge.edge / 12.0;
        var energy = sponge.stretch_modulus * dot(lengths, lengths)
            + sponge.shear_modulus * dot(shears, shears)
            + sponge.volume_modulus * (ratio - 1.0) * (ratio - 1.0);
        if (solver == SOLVER_VBD) {
            // mu (|F|^2 - 3 - 2 ln J) + (lambda - mu) (J - 1)^2, in differences from rest.
            let minimum = max(ratio, POLYNOMIAL_RATIO);
            let beyond = ratio / minimum - 1.0;
            let logarithm = log(minimum) + beyond - 0.5 * beyond * beyond;
            let first_order = lengths.x + lengths.y + lengths.z - logarithm;
            energy = sponge.mu * (dot(lengths, lengths) + 2.0 * first_order)
                + (sponge.lambda - sponge.mu) * (ratio - 1.0) * (ratio - 1.0);
        } else if (solver == SOLVER_XPBD_NEO_HOOKEAN) {
            // mu (|F|^2 - 3) + lambda ((J - alpha)^2 - (1 - alpha)^2), in differences from rest.
            let first_order = lengths.x + lengths.y + lengths.z - (ratio - 1.0);
            energy = sponge.mu * (dot(lengths, lengths) + 2.0 * first_order)
                + sponge.lambda * (ratio - 1.0) * (ratio - 1.0);
        }
        let weight = tet_weight[row];
        // The constraints of strain based dynamics know the tets alone.
        let strained = select(1.0, weight, solver == SOLVER_VBD || solver == SOLVER_XPBD_NEO_HOOKEAN);
        own.a = vec4<f32>(volume * weight * ratio, 0.5 * volume * strained * energy, 0.0, 0.0);
    }
    write_sums(group_of(group, groups), lane, group_sums(lane, own));
}
