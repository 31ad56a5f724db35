// #include sponges
// Strain constraints of the tets of one colour; `strain.rs` has the formulas. No two tets of a colour share a node.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<uniform> batch: Batch;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> tets: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> tet_sponge: array<u32>;
@group(0) @binding(6) var<storage, read_write> node_predicted: array<vec4<f32>>;

// Predicted positions and inverse masses, positions at the beginning of the step.
var<private> p0: vec3<f32>;
var<private> p1: vec3<f32>;
var<private> p2: vec3<f32>;
var<private> p3: vec3<f32>;
var<private> old0: vec3<f32>;
var<private> old1: vec3<f32>;
var<private> old2: vec3<f32>;
var<private> old3: vec3<f32>;
var<private> w: vec4<f32>;
var<private> inverse_edge: f32;

// Columns of the deformation gradient in the frame of the tet.
fn column_d() -> vec3<f32> {
    return (p1 - p0) * inverse_edge;
}

fn column_e() -> vec3<f32> {
    return (p2 - p3) * inverse_edge;
}

fn column_f() -> vec3<f32> {
    return ((p2 + p3) - (p0 + p1)) * inverse_edge;
}

// Moves the nodes along the gradient of one constraint, given times the edge.
fn correct(
    constraint: f32,
    g0: vec3<f32>,
    g1: vec3<f32>,
    g2: vec3<f32>,
    g3: vec3<f32>,
    compliance: f32,
    damping: f32,
) {
    let weight = w.x * dot(g0, g0) + w.y * dot(g1, g1) + w.z * dot(g2, g2) + w.w * dot(g3, g3);
    let rate = dot(g0, p0 - old0) + dot(g1, p1 - old1) + dot(g2, p2 - old2) + dot(g3, p3 - old3);
    let numerator = constraint + damping * (rate * inverse_edge);
    let denominator = (1.0 + damping) * (weight * (inverse_edge * inverse_edge)) + compliance;
    let impulse = -(numerator / denominator) * inverse_edge;
    p0 += g0 * (impulse * w.x);
    p1 += g1 * (impulse * w.y);
    p2 += g2 * (impulse * w.z);
    p3 += g3 * (impulse * w.w);
}

fn inverse_length(length: f32) -> f32 {
    return select(1.0, 1.0 / length, length > MINIMUM_STRETCH);
}

fn stretch(compliance: f32, damping: f32) {
    let none = vec3<f32>(0.0);
    let d = column_d();
    var length = sqrt(dot(d, d));
    var n = d * inverse_length(length);
    correct(length - 1.0, -n, n, none, none, compliance, damping);
    let e = column_e();
    length = sqrt(dot(e, e));
    n = e * inverse_length(length);
    correct(length - 1.0, none, none, n, -n, compliance, damping);
    let f = column_f();
    length = sqrt(dot(f, f));
    n = f * inverse_length(length);
    correct(length - 1.0, -n, -n, n, n, compliance, damping);
}

fn shear(compliance: f32, damping: f32) {
    var d = column_d();
    var e = column_e();
    correct(dot(d, e), -e, e, d, -d, compliance, damping);
    d = column_d();
    var f = column_f();
    correct(dot(d, f), -(f + d), f - d, d, d, compliance, damping);
    e = column_e();
    f = column_f();
    correct(dot(e, f), -e, -e, f + e, e - f, compliance, damping);
}

fn volume(compliance: f32, damping: f32, limit: bool) {
    let d = column_d();
    let e = column_e();
    let f = column_f();
    let by_d = cross(e, f);
    let by_e = cross(f, d);
    let by_f = cross(d, e);
    let ratio = dot(d, by_d);
    let constraint = select(ratio - 1.0, min(ratio - MINIMUM_VOLUME_RATIO, 0.0), limit);
    correct(constraint, -(by_d + by_f), by_d - by_f, by_e + by_f, by_f - by_e, compliance, damping);
}

@compute @workgroup_size(GROUP)
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
    if (sponge.solver != SOLVER_SBD) {
        return;
    }
    let a = node_predicted[tet.x];
    let b = node_predicted[tet.y];
    let c = node_predicted[tet.z];
    let d = node_predicted[tet.w];
    p0 = a.xyz;
    p1 = b.xyz;
    p2 = c.xyz;
    p3 = d.xyz;
    w = vec4<f32>(
        a[NODE_PREDICTED_INVERSE_MASS],
        b[NODE_PREDICTED_INVERSE_MASS],
        c[NODE_PREDICTED_INVERSE_MASS],
        d[NODE_PREDICTED_INVERSE_MASS],
    );
    old0 = node_position[tet.x].xyz;
    old1 = node_position[tet.y].xyz;
    old2 = node_position[tet.z].xyz;
    old3 = node_position[tet.w].xyz;
    inverse_edge = 1.0 / sponge.edge;
    let rest = sponge.edge * sponge.edge * sponge.edge / 12.0;
    // Iterations restart from no impulse: each takes its share of the stiffness.
    let per_modulus = f32(sponge.iterations) / (rest * clock.step * clock.step);
    let damping = sponge.damping_time / clock.step;
    stretch(per_modulus / sponge.stretch_modulus, damping);
    shear(per_modulus / sponge.shear_modulus, damping);
    volume(per_modulus / sponge.volume_modulus, damping, false);
    volume(per_modulus / sponge.volume_modulus * LIMIT_COMPLIANCE, 0.0, true);
    node_predicted[tet.x] = vec4<f32>(p0, a[NODE_PREDICTED_INVERSE_MASS]);
    node_predicted[tet.y] = vec4<f32>(p1, b[NODE_PREDICTED_INVERSE_MASS]);
    node_predicted[tet.z] = vec4<f32>(p2, c[NODE_PREDICTED_INVERSE_MASS]);
    node_predicted[tet.w] = vec4<f32>(p3, d[NODE_PREDICTED_INVERSE_MASS]);
}
