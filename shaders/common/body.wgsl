// Rigid bodies, as in `body.rs`.

const PLANE: u32 = 0u;
const SPHERE: u32 = 1u;
const CUBOID: u32 = 2u;
const CAPSULE: u32 = 3u;

struct Body {
    position: vec4<f32>,
    // Columns of the rotation matrix.
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
    linear: vec4<f32>,
    angular: vec4<f32>,
    // Half extents of a cuboid; x: half the length of a capsule's segment; w: radius.
    extents: vec4<f32>,
    // Shape, first face plane, face planes, 1 if sponge nodes are kept out.
    info: vec4<u32>,
    // x: Coulomb friction; y: 1 if the fluid does not slide along it.
    surface: vec4<f32>,
}

fn body_velocity(body: Body, point: vec3<f32>) -> vec3<f32> {
    return body.linear.xyz + cross(body.angular.xyz, point - body.position.xyz);
}
