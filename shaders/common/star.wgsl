// The star of a node; `stars.rs` has its layout. Used with the binding `stars`.

// Words of a star: 8 corners, 6 directions, tets, sponge, bits of the wetness, index of the weights of the tets.
const STAR: u32 = 18u;
const DIRECTION: u32 = 8u;
const TETS: u32 = 14u;
const SPONGE: u32 = 15u;
const WETNESS: u32 = 16u;
const WEIGHTS: u32 = 17u;
// Words of the contact of a node, behind the stars of all nodes.
const TOUCH: u32 = 9u;

const RINGS = array<vec4<u32>, 6>(
    vec4<u32>(6u, 4u, 0u, 2u),
    vec4<u32>(7u, 3u, 1u, 5u),
    vec4<u32>(5u, 1u, 0u, 4u),
    vec4<u32>(7u, 6u, 2u, 3u),
    vec4<u32>(3u, 2u, 0u, 1u),
    vec4<u32>(7u, 5u, 4u, 6u),
);
