//! The WGSL twins of the kernels of sorb: text only, no dependencies.
//!
//! A twin has the path of its kernel: the twin of `sph::density` is `sph/density.wgsl`. A kernel that needs several
//! passes has further files beside it, and what several twins need is in `common/`. Which passes make up a kernel, and
//! which buffers they are bound to, is in the table of `sorb-kernels`.

/// The WGSL source of one pass, complete: what it shares with others comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Name of the file, `family::name`.
    pub name: &'static str,
    /// WGSL text.
    pub source: &'static str,
}

macro_rules! shaders {
    ($($family:ident::$file:ident: $($common:ident)*;)*) => {
        &[$(Shader {
            name: concat!(stringify!($family), "::", stringify!($file)),
            source: concat!(
                include_str!("../common/layout.wgsl"),
                $(include_str!(concat!("../common/", stringify!($common), ".wgsl")),)*
                include_str!(concat!("../", stringify!($family), "/", stringify!($file), ".wgsl")),
            ),
        }),*]
    };
}

/// All passes, by family, with the common files that each is built from.
pub static SHADERS: &[Shader] = shaders! {
    clock::clock: ;
    clock::rounds: ;
    couple::begin_drag: ;
    couple::control_velocity: smoothing drag control_group;
    couple::controls: sponges grid;
    couple::drag: smoothing drag;
    couple::drag_impulse: smoothing drag;
    couple::drag_reaction: smoothing control_group;
    couple::drag_settled: ;
    couple::drag_target: smoothing control_group received;
    couple::exchange: smoothing control_group received;
    couple::exchange_fluid: ;
    couple::expect_solid: sponges;
    couple::interior: smoothing;
    couple::near_controls: grid;
    couple::near_fluid: grid;
    couple::node_velocity: ;
    couple::pores: sponges star;
    couple::saturation: smoothing sponges control_group;
    couple::solid_pressure: smoothing;
    couple::solid_reaction: smoothing control_group;
    couple::solid_share: smoothing;
    couple::solid_yield: smoothing;
    couple::suction: smoothing;
    couple::velocity_filter: smoothing control_group received;
    couple::wetting: sponges star;
    couple::zero_distance: smoothing sponges control_group;
    grid::count: grid;
    grid::fluid_neighbors: grid smoothing;
    grid::scan_pages: grid scan;
    grid::scan_sums: grid scan;
    grid::scatter: grid;
    grid::sort_fluid: grid;
    measure::fluid: sums partial_sums;
    measure::nodes: sums partial_sums;
    measure::tets: sponges sums partial_sums;
    measure::total: sums;
    pbd::boxes: sponges;
    pbd::contact: body surface sweep sponges wrench;
    pbd::gravity: ;
    pbd::guess: sponges;
    pbd::joining: ;
    pbd::momentum: sponges;
    pbd::momentum_bodies: body surface sponges wrench;
    pbd::momentum_sums: sponges;
    pbd::normals: sponges star meeting;
    pbd::pairs: grid sponges star meeting;
    pbd::predict: body;
    pbd::reaction: body surface sweep sponges wrench star descent;
    pbd::strain: sponges;
    pbd::touch: sponges star meeting;
    pbd::touching: ;
    pbd::vbd: body surface sweep sponges star descent;
    pbd::velocity: sponges;
    pbd::xpbd_neo_hookean: sponges;
    sph::advect: ;
    sph::body_wrenches: wrench;
    sph::boundary: body surface profile;
    sph::boundary_pressure: body surface wrench profile;
    sph::boundary_reaction: body surface wrench profile;
    sph::density: smoothing images;
    sph::factors: smoothing sums roughness images;
    sph::forces: smoothing images;
    sph::kick: ;
    sph::position_correction: ;
    sph::predict: roughness;
    sph::pressure: ;
    sph::pressure_acceleration: smoothing middle roughness images;
    sph::pressure_kick: ;
    sph::pressure_residual: smoothing middle sums roughness images;
    sph::pressure_update: solve;
    sph::repulsion: body surface wrench;
    sph::solve_begin: sums solve;
    sph::solve_round: sums solve;
    sph::cohesion: smoothing images;
    sph::deficit: smoothing images body surface;
    sph::surface_tension: smoothing images;
    sph::sweep: body surface wrench sweep;
    sph::viscosity_begin: smoothing images viscosity viscosity_solve;
    sph::viscosity_friction: body surface friction;
    sph::viscosity_kick: viscosity_solve;
    sph::viscosity_length: sums viscosity_solve;
    sph::viscosity_product: smoothing images viscosity sums;
    sph::viscosity_reaction: body surface wrench friction;
    sph::viscosity_round: sums viscosity_solve;
    sph::viscosity_update: sums viscosity_solve;
    sph::wall_friction: body surface wrench friction;
};

/// The same passes with subgroup operations, for adapters that have them.
pub static SUBGROUP_SHADERS: &[Shader] = shaders! {
    grid::scan_pages: grid scan_subgroup;
    grid::scan_sums: grid scan_subgroup;
};

/// The pass of that name with subgroup operations, if it has use for them.
#[must_use]
pub fn subgroup_shader(name: &str) -> Option<&'static Shader> {
    SUBGROUP_SHADERS.iter().find(|shader| shader.name == name)
}

/// The pass of that name.
#[must_use]
pub fn shader(name: &str) -> Option<&'static Shader> {
    SHADERS.iter().find(|shader| shader.name == name)
}
