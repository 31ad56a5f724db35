// #include sponges
// What compression does to the pores of a sponge; `pores.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_stars: array<u32>;
@group(0) @binding(5) var<storage, read_write> node_pores: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let base = row * STAR_WORDS;
    let sponge = sponges.all[node_stars[base + STAR_SPONGE]];
    if (is_asleep(sponge)) {
        return;
    }
    if (sponge.pores_close == 0u) {
        node_pores[row] = vec4<f32>(1.0, sponge.drag_rate, sponge.inertial_drag_rate, sponge.porosity);
        return;
    }
    let tets = node_stars[base + STAR_TETS];
    let weights = node_stars[base + STAR_WEIGHTS];
    let x = node_position[row].xyz;
    var rings = RINGS;
    var sum = 0.0;
    var all = 0.0;
    for (var direction = 0u; direction < DIRECTIONS; direction += 1u) {
        let ring = rings[direction];
        let u = node_position[node_stars[base + STAR_DIRECTIONS + direction]].xyz;
        for (var k = 0u; k < 4u; k += 1u) {
            let tet = 4u * direction + k;
            if (((tets >> tet) & 1u) == 0u) {
                continue;
            }
            // Without a table all weights are 1.
            var weight = 1.0;
            if (weights != 0u) {
                weight = bitcast<f32>(node_stars[weights + tet]);
            }
            let r = node_position[node_stars[base + ring[k]]].xyz;
            let q = node_position[node_stars[base + ring[(k + 1u) % 4u]]].xyz;
            sum += dot(u - x, cross(q - u, r - u)) * weight;
            all += weight;
        }
    }
    let volume = 2.0 * sum / (sponge.edge * sponge.edge * sponge.edge);
    let minimum = (1.0 - sponge.porosity) / (1.0 - min(MINIMUM_POROSITY, sponge.porosity));
    let ratio = clamp(volume / all, minimum, MAXIMUM_VOLUME_RATIO);
    let porosity = 1.0 - (1.0 - sponge.porosity) / ratio;
    let opening = porosity / sponge.porosity;
    let crowding = (1.0 - sponge.porosity) / (1.0 - porosity);
    let permeability = opening * opening * opening * (crowding * crowding);
    node_pores[row] = vec4<f32>(
        ratio,
        sponge.drag_rate * opening / permeability * ratio,
        sponge.inertial_drag_rate * (opening * opening) / sqrt(permeability) * ratio,
        porosity,
    );
    if (sponge.wetting.swelling > 0.0) {
        let size = 1.0 + sponge.wetting.swelling * bitcast<f32>(node_stars[base + STAR_WETNESS]);
        let swollen = size * size * size;
        node_pores[row] = vec4<f32>(node_pores[row].xyz / swollen, porosity);
    }
}
