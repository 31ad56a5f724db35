// #include numbers, scene
// The samples as a picture: four bytes a pixel, rows padded to a multiple of 256 bytes, as copies to textures want it.

@group(0) @binding(1) var<storage, read> samples: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> picture: array<u32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= scene.width || id.y >= scene.height) {
        return;
    }
    let word = samples[id.y * scene.width + id.x].x;
    let channels = vec3(word, word >> 10u, word >> 20u) & vec3(PIXELS_MOST);
    let bytes = (channels * 1021u + 2048u) >> vec3(12u);
    picture[id.y * scene.row_words + id.x] = bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | 0xff000000u;
}
