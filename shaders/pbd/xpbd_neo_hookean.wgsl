// #include sponges
// Neo-Hookean constraints of the tets of one colour; `xpbd_neo_hookean.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<uniform> batch: Batch;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> tets: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> tet_sponge: array<u32>;
@group(0) @binding(6) var<storage, read> tet_weight: array<f32>;
@group(0) @binding(7) var<storage, read_write> node_predicted: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= batch.count) {
        return;
    }
    let tet = tets[batch.first + row];
    let sponge = sponges.all[tet_sponge[batch.first + row]];
    if (sponge.solver != SOLVER_XPBD_NEO_HOOKEAN) {
        return;
    }
    let p = array<vec4<f32>, 4>(node_predicted[tet.x], node_predicted[tet.y], node_predicted[tet.z], node_predicted[tet.w]);
    let old = array<vec3<f32>, 4>(
        node_position[tet.x].xyz,
        node_position[tet.y].xyz,
        node_position[tet.z].xyz,
        node_position[tet.w].xyz,
    );
    let scale = 1.0 / sponge.edge;
    let d = (p[1].xyz - p[0].xyz) * scale;
    let e = (p[2].xyz - p[3].xyz) * scale;
    let f = ((p[2].xyz + p[3].xyz) - (p[0].xyz + p[1].xyz)) * scale;
    let area_d = cross(e, f);
    let area_e = cross(f, d);
    let area_f = cross(d, e);
    let square = dot(d, d) + dot(e, e) + dot(f, f);
    let inverse = 1.0 / select(1.0, square, square > MINIMUM_SQUARE);
    let by_norm = array<vec3<f32>, 4>(-(d + f), d - f, e + f, f - e);
    let apart_d = area_d - d;
    let apart_e = area_e - e;
    let apart_f = area_f - f;
    let apart = array<vec3<f32>, 4>(-(apart_d + apart_f), apart_d - apart_f, apart_e + apart_f, apart_f - apart_e);
    let change_of_ratio = dot(d, area_d) - 1.0;
    var nn = 0.0;
    var na = 0.0;
    var aa = 0.0;
    var norm_rate = 0.0;
    var apart_rate = 0.0;
    for (var vertex = 0; vertex < 4; vertex += 1) {
        let n = by_norm[vertex];
        let a = apart[vertex];
        let w = p[vertex][NODE_PREDICTED_INVERSE_MASS];
        nn += w * dot(n, n);
        na += w * dot(n, a);
        aa += w * dot(a, a);
        let way = p[vertex].xyz - old[vertex];
        norm_rate += dot(n, way);
        apart_rate += dot(a, way);
    }
    let rest = tet_weight[batch.first + row] * sponge.edge * sponge.edge * sponge.edge / 12.0;
    let soft_norm = 1.0 / (sponge.mu * rest * clock.step * clock.step);
    let soft_ratio = 1.0 / (sponge.lambda * rest * clock.step * clock.step);
    let damping = sponge.damping / clock.step;
    let factor = (1.0 + damping) * (scale * scale);
    nn = nn * factor;
    na = na * factor;
    aa = aa * factor;
    let slowed_norm = damping * (norm_rate * scale) * inverse;
    let slowed_ratio = damping * ((norm_rate + apart_rate) * scale);
    let right = sponge.mu / sponge.lambda - change_of_ratio - slowed_ratio;
    let determinant = (nn * aa - na * na + nn * soft_ratio) * inverse + (nn + na + na + aa + soft_ratio) * soft_norm;
    let both = na + aa;
    let sum = -(both + na * (right * inverse)) - soft_norm * (change_of_ratio + slowed_ratio)
        - (both + soft_ratio) * slowed_norm;
    let to_both = sum / determinant * scale;
    let to_apart = (nn * (right * inverse) + (nn + na) * (1.0 + slowed_norm) + soft_norm * right) / determinant * scale;
    let rows = array<u32, 4>(tet.x, tet.y, tet.z, tet.w);
    for (var vertex = 0; vertex < 4; vertex += 1) {
        let change = by_norm[vertex] * to_both + apart[vertex] * to_apart;
        node_predicted[rows[vertex]] = with_vector(p[vertex], p[vertex].xyz + change * p[vertex][NODE_PREDICTED_INVERSE_MASS]);
    }
}
