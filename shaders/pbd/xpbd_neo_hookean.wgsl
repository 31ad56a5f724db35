// Neo-Hookean constraints of the tets of one colour; `xpbd_neo_hookean.rs` has the formulas.

struct Batch {
    first: u32,
    count: u32,
    unused_0: u32,
    unused_1: u32,
}

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<uniform> batch: Batch;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> tets: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> tet_sponge: array<u32>;
@group(0) @binding(6) var<storage, read_write> predicted: array<vec4<f32>>;

@compute @workgroup_size(256)
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
    if (sponge.solver != XPBD_NEO_HOOKEAN) {
        return;
    }
    let p = array<vec4<f32>, 4>(predicted[tet.x], predicted[tet.y], predicted[tet.z], predicted[tet.w]);
    let old = array<vec3<f32>, 4>(
        position[tet.x].xyz,
        position[tet.y].xyz,
        position[tet.z].xyz,
        position[tet.w].xyz,
    );
    let scale = 1.0 / sponge.edge;
    let d = (p[1].xyz - p[0].xyz) * scale;
    let e = (p[2].xyz - p[3].xyz) * scale;
    let f = ((p[2].xyz + p[3].xyz) - (p[0].xyz + p[1].xyz)) * scale;
    let norm = sqrt(dot(d, d) + dot(e, e) + dot(f, f));
    let inverse = select(1.0, 1.0 / norm, norm > 1.0e-6);
    let by_norm = array<vec3<f32>, 4>(-(d + f) * inverse, (d - f) * inverse, (e + f) * inverse, (f - e) * inverse);
    let by_d = cross(e, f);
    let by_e = cross(f, d);
    let by_f = cross(d, e);
    let by_ratio = array<vec3<f32>, 4>(-(by_d + by_f), by_d - by_f, by_e + by_f, by_f - by_e);
    let ratio = dot(d, by_d) - (1.0 + sponge.mu / sponge.lambda);
    var nn = 0.0;
    var rr = 0.0;
    var nr = 0.0;
    var norm_rate = 0.0;
    var ratio_rate = 0.0;
    for (var vertex = 0; vertex < 4; vertex += 1) {
        let n = by_norm[vertex];
        let r = by_ratio[vertex];
        let w = p[vertex].w;
        nn += w * dot(n, n);
        rr += w * dot(r, r);
        nr += w * dot(n, r);
        let way = p[vertex].xyz - old[vertex];
        norm_rate += dot(n, way);
        ratio_rate += dot(r, way);
    }
    let rest = sponge.edge * sponge.edge * sponge.edge / 12.0;
    let damping = sponge.damping / clock.step;
    let factor = (1.0 + damping) * (scale * scale);
    nn = nn * factor + 1.0 / (sponge.mu * rest * clock.step * clock.step);
    rr = rr * factor + 1.0 / (sponge.lambda * rest * clock.step * clock.step);
    nr = nr * factor;
    let first = -(norm + damping * (norm_rate * scale));
    let second = -(ratio + damping * (ratio_rate * scale));
    let determinant = nn * rr - nr * nr;
    let to_norm = (rr * first - nr * second) / determinant * scale;
    let to_ratio = (nn * second - nr * first) / determinant * scale;
    let rows = array<u32, 4>(tet.x, tet.y, tet.z, tet.w);
    for (var vertex = 0; vertex < 4; vertex += 1) {
        let change = by_norm[vertex] * to_norm + by_ratio[vertex] * to_ratio;
        predicted[rows[vertex]] = vec4<f32>(p[vertex].xyz + change * p[vertex].w, p[vertex].w);
    }
}
