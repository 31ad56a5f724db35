// Densities between nodes.

@group(0) @binding(1) var<storage, read> densities: array<f32>;

// The value at a point, linear; outside of the grid that of its border.
fn density_at(point: vec3<f32>) -> f32 {
    let last = vec3<f32>(scene.field_sides) - 1.001;
    let place = clamp((point - scene.field_origin) * scene.field_inverse, vec3(0.0), last);
    let node = vec3<u32>(place);
    let f = place - vec3<f32>(node);
    let row = scene.field_sides.x;
    let layer = row * scene.field_sides.y;
    let at = node.z * layer + node.y * row + node.x;
    let near = mix(mix(densities[at], densities[at + 1u], f.x), mix(densities[at + row], densities[at + row + 1u], f.x), f.y);
    let far_at = at + layer;
    let far = mix(
        mix(densities[far_at], densities[far_at + 1u], f.x),
        mix(densities[far_at + row], densities[far_at + row + 1u], f.x),
        f.y,
    );
    return mix(near, far, f.z);
}
