// What every pass knows of the picture. The struct is declared in Rust.
@group(0) @binding(0) var<uniform> scene: Scene;
