//! Constants and structs that Rust declares, as WGSL text that is appended to every shader of the renderer.

use std::sync::LazyLock;

use sorb_kernels::gpu::ShapeKind;

use super::scene::{FAR_AWAY, Scene};
use crate::render::{
    View, colour, rays,
    shared::Constant,
    water::{self, Content},
};

/// Threads of a group of passes whose threads have nothing to do with each other.
pub(super) const GROUP: u32 = 64;
/// Threads of a group that sums up over cells, and cells of each.
pub(super) const PAGE_THREADS: u32 = 256;
pub(super) const PAGE_SHARE: u32 = 4;
/// Threads that share a kernel.
const DENSITY_THREADS: u32 = 64;
/// One over the step of sums in fixed point. Sums up to 1024 fit.
const FIXED_POINT: f32 = 4_194_304.0;
/// Most parts of the tree that wait for their turn, and the mark of a lane of a node without a part.
const TREE_STACK: u32 = 32;
pub(super) const TREE_NOTHING: u32 = u32::MAX;
/// Rows of a body.
pub(super) const BODY_ROWS: u32 = 8;

macro_rules! constants {
    ($($name:ident = $value:expr),+ $(,)?) => {
        &[$(Constant { name: stringify!($name), value: &$value }),+]
    };
}

/// Constants of the passes themselves.
const OWN: &[Constant] = constants! {
    FAR_AWAY = FAR_AWAY,
    GROUP = GROUP,
    PAGE_THREADS = PAGE_THREADS,
    PAGE_SHARE = PAGE_SHARE,
    DENSITY_THREADS = DENSITY_THREADS,
    FIXED_POINT = FIXED_POINT,
    TREE_STACK = TREE_STACK,
    TREE_NOTHING = TREE_NOTHING,
    BODY_ROWS = BODY_ROWS,
    SHAPE_PLANE = ShapeKind::Plane as u32,
    SHAPE_SPHERE = ShapeKind::Sphere as u32,
    SHAPE_CUBOID = ShapeKind::Cuboid as u32,
    SHAPE_CAPSULE = ShapeKind::Capsule as u32,
    SHAPE_HULL = ShapeKind::Hull as u32,
    VIEW_PRESSURE = View::Pressure as u32,
    VIEW_SPEED = View::Speed as u32,
    VIEW_CUTAWAY = View::Cutaway as u32,
    BRICK_AIR = Content::Air as u32,
    BRICK_WATER = Content::Water as u32,
    BRICK_SURFACE = Content::Surface as u32,
    MATTER_NOTHING = 0_u32,
    MATTER_FLOOR = 1_u32,
    MATTER_SPONGE = 2_u32,
    MATTER_BODY = 3_u32,
    MATTER_BEAD = 4_u32,
    RAY_MAIN = 0_u32,
    RAY_MIRROR = 1_u32,
    RAY_INSIDE = 2_u32,
    RAY_SHEET = 3_u32,
    RAY_BELOW = 4_u32,
    EVENT_NOTHING = 0_u32,
    EVENT_MATTER = 1_u32,
    EVENT_CLEAR = 2_u32,
    EVENT_SURFACE = 3_u32,
    EDGES_LISTED = 1_u32,
};

/// Declarations of all of them.
pub(super) static DECLARATIONS: LazyLock<String> = LazyLock::new(|| {
    let files = rays::CONSTANTS.iter().chain(water::CONSTANTS).copied();
    let all = files.chain([colour::CONSTANTS, OWN]).flatten();
    all.map(Constant::wgsl).chain([Scene::wgsl()]).collect()
});
