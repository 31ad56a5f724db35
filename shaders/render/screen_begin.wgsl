// #include numbers, scene
// Depth and thickness of the water on the screen as numbers.

@group(0) @binding(1) var<storage, read> depths: array<u32>;
@group(0) @binding(2) var<storage, read> thicknesses: array<u32>;
// Depth along the line of sight (m), `FAR_AWAY` without water, and length of water along the ray (m).
@group(0) @binding(3) var<storage, read_write> water: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= scene.screen_width || id.y >= scene.screen_height) {
        return;
    }
    let sample = id.y * scene.screen_width + id.x;
    let depth = select(FAR_AWAY, bitcast<f32>(~depths[sample]), depths[sample] != 0u);
    water[sample] = vec4(depth, of_fixed(thicknesses[sample]), 0.0, 0.0);
}
