// The pores of the sponge: a periodic field of distances from their walls (mm), negative in a pore.
@group(0) @binding(6) var<storage, read> foam: array<f32>;

fn foam_at(x: u32, y: u32, z: u32) -> f32 {
    return foam[((z & (FOAM_SIDE - 1u)) * FOAM_SIDE + (y & (FOAM_SIDE - 1u))) * FOAM_SIDE + (x & (FOAM_SIDE - 1u))];
}

fn foam_row(x: u32, y: u32, z: u32, f: f32) -> f32 {
    let a = foam_at(x, y, z);
    return a + (foam_at(x + 1u, y, z) - a) * f;
}

fn foam_plane(x: u32, y: u32, z: u32, f: vec3<f32>) -> f32 {
    let a = foam_row(x, y, z, f.x);
    return a + (foam_row(x, y + 1u, z, f.x) - a) * f.y;
}

// Distance from the wall of a pore (mm) at a place in the sponge at rest (m).
fn foam_distance(place: vec3<f32>) -> f32 {
    // Shifted by whole periods, so that cutting rounds down.
    let at = max(place * (f32(FOAM_SIDE) / FOAM_PERIOD) + f32(64u * FOAM_SIDE), vec3(0.0));
    let k = vec3<u32>(at);
    let f = at - vec3<f32>(k);
    let a = foam_plane(k.x, k.y, k.z, f);
    return a + (foam_plane(k.x, k.y, k.z + 1u, f) - a) * f.z;
}
