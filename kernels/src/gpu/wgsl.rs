//! Constants, enumerations and structs that Rust declares, as WGSL text that is appended to every shader.

use std::sync::LazyLock;

use super::{
    answer::{Clock, Extreme, Status},
    bodies::{self, DeviceBody, ShapeKind},
    capacities::List,
    cells::{self, Grid},
    groups,
    image_layout::{self, DeviceImage},
    layout::{Constant, Enumeration, Shape, Struct},
    pack::{self, Batch, NodeTraits, Repetition, StepParams, Summands},
    query_layout::{self, QueryAnswer, Question},
    stars,
    sum_layout::{self, GroupSums},
};
use crate::{
    KERNELS,
    clock::{self, Bound},
    column::{self, Element},
    columns::Column,
    couple, divergence,
    params::{self, EquationOfState, Solver, SpongeParams, WettingParams},
    pbd,
    smoothing::{self, Wendland},
    sph::{self, pressure_solve::Solve, viscosity_solve::State as ViscositySolve},
    surface, sweep, tets,
    turn::Turn,
};

/// Constants of modules that are no kernels.
const CONSTANTS: &[&[Constant]] = &[
    bodies::CONSTANTS,
    cells::CONSTANTS,
    clock::CONSTANTS,
    column::CONSTANTS,
    couple::compliance::CONSTANTS,
    couple::drag_model::CONSTANTS,
    couple::impulses::CONSTANTS,
    divergence::collect::CONSTANTS,
    divergence::image_rows::CONSTANTS,
    divergence::mirror::CONSTANTS,
    divergence::rate::CONSTANTS,
    divergence::walls::CONSTANTS,
    groups::CONSTANTS,
    image_layout::CONSTANTS,
    pack::CONSTANTS,
    params::CONSTANTS,
    pbd::descent::CONSTANTS,
    pbd::lattice::CONSTANTS,
    pbd::meeting::CONSTANTS,
    pbd::obstacles::CONSTANTS,
    pbd::stars::CONSTANTS,
    query_layout::CONSTANTS,
    smoothing::CONSTANTS,
    sph::container::CONSTANTS,
    sph::friction::CONSTANTS,
    sph::obstacles::CONSTANTS,
    sph::pressure_solve::CONSTANTS,
    sph::strain::CONSTANTS,
    stars::CONSTANTS,
    sum_layout::CONSTANTS,
    surface::CONSTANTS,
    sweep::CONSTANTS,
    tets::rows::CONSTANTS,
];

/// All constants.
fn constants() -> impl Iterator<Item = &'static Constant> {
    CONSTANTS.iter().copied().chain(KERNELS.iter().map(|kernel| kernel.constants)).flatten()
}

/// The lanes of all columns: `INVERSE_MASS` of `node_position` is `NODE_POSITION_INVERSE_MASS`.
fn lanes() -> String {
    let mut text = String::new();
    for column in Column::ALL {
        let Element::Rows(lanes) = column.element() else { continue };
        for lane in lanes.iter().filter(|lane| !lane.name.is_empty()) {
            let name = format!("{}_{}", column.buffer().to_uppercase(), lane.name);
            text.push_str(&format!("const {name}: u32 = {}u;\n", lane.index));
        }
    }
    text
}

/// Declarations of all of them.
static DECLARATIONS: LazyLock<String> = LazyLock::new(|| {
    let constants: String = constants().map(Constant::wgsl).collect();
    let enumerations = [
        Bound::wgsl(),
        EquationOfState::wgsl(),
        Extreme::wgsl(),
        List::wgsl(),
        ShapeKind::wgsl(),
        Solver::wgsl(),
        Status::wgsl(),
    ];
    let structs: String = STRUCTS.iter().map(Shape::wgsl).collect();
    [constants, lanes(), enumerations.concat(), structs].concat()
});

/// Structs.
const STRUCTS: &[Shape] = &[
    Batch::SHAPE,
    Clock::SHAPE,
    DeviceBody::SHAPE,
    DeviceImage::SHAPE,
    Grid::SHAPE,
    GroupSums::SHAPE,
    NodeTraits::SHAPE,
    QueryAnswer::SHAPE,
    Question::SHAPE,
    Repetition::SHAPE,
    Solve::SHAPE,
    SpongeParams::SHAPE,
    StepParams::SHAPE,
    Summands::SHAPE,
    Turn::SHAPE,
    ViscositySolve::SHAPE,
    Wendland::SHAPE,
    WettingParams::SHAPE,
];

/// The text of a shader with what it needs of the declarations: behind it, so that lines keep their numbers.
pub(crate) fn complete(source: &str) -> String {
    [source, &DECLARATIONS].concat()
}

#[cfg(test)]
mod tests {
    use wgpu::naga::{Expression, Literal, Module, TypeInner, front::wgsl::parse_str, proc::Layouter};

    use super::*;
    use crate::gpu::layout::{Value, place_of};

    fn parsed(text: &str) -> Module {
        parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)))
    }

    /// The bits of a constant that shaders compute with.
    fn bits(module: &Module, name: &str) -> Option<u32> {
        let found = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name));
        match module.global_expressions[found?.1.init] {
            Expression::Literal(Literal::F32(value)) => Some(value.to_bits()),
            Expression::Literal(Literal::U32(value)) => Some(value),
            _ => None,
        }
    }

    /// Fields, offsets and sizes of a struct of WGSL that are not those of Rust.
    fn differences(module: &Module, shape: &Shape) -> Vec<String> {
        let mut layouts = Layouter::default();
        layouts.update(module.to_ctx()).unwrap_or_else(|error| panic!("{error}"));
        let found = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(shape.name));
        let Some(TypeInner::Struct { members, span }) = found.map(|(_, kind)| &kind.inner) else {
            return vec![format!("no {}", shape.name)];
        };
        let of_wgsl = members.iter().map(|member| {
            let name = member.name.clone().unwrap_or_default();
            (name, member.offset as usize, layouts[member.ty].size as usize)
        });
        let of_rust =
            shape.fields.iter().map(|field| (field.name.to_owned(), 4 * field.place, 4 * field.words));
        let (of_wgsl, of_rust): (Vec<_>, Vec<_>) = (of_wgsl.collect(), of_rust.collect());
        let only = |own: &[(String, usize, usize)], others: &[(String, usize, usize)]| -> Vec<String> {
            let own = own.iter().filter(|field| !others.contains(field));
            own.map(|field| format!("{}: {field:?}", shape.name)).collect()
        };
        let mut all = [only(&of_wgsl, &of_rust), only(&of_rust, &of_wgsl)].concat();
        if *span as usize != 4 * shape.words {
            all.push(format!("{}: {span} bytes for {} words", shape.name, shape.words));
        }
        all
    }

    #[test]
    fn structs_have_the_fields_offsets_and_sizes_of_rust() {
        let module = parsed(&DECLARATIONS);
        for shape in STRUCTS {
            assert_eq!(differences(&module, shape), Vec::<String>::new());
        }
    }

    #[test]
    fn a_field_that_is_elsewhere_is_noticed() {
        for (right, wrong) in [
            ("    inverse_step: f32,\n    running: u32,\n", "    running: u32,\n    inverse_step: f32,\n"),
            ("    inverse_step: f32,\n", "    inverse_step: vec3<f32>,\n"),
            ("    inverse_step: f32,\n", ""),
            ("    given: u32,\n", "    given: u32,\n    more: vec4<u32>,\n"),
        ] {
            let text = DECLARATIONS.replace(right, wrong);
            assert_ne!(text, *DECLARATIONS, "{right}");
            let module = parsed(&text);
            assert_ne!(differences(&module, &Clock::SHAPE), Vec::<String>::new(), "{wrong}");
            assert_eq!(differences(&module, &Grid::SHAPE), Vec::<String>::new());
        }
    }

    /// What is put into words is where the fields are.
    #[test]
    fn words_are_at_the_places_of_their_fields() {
        let clock = Clock::take(&(0..Clock::WORDS as u32).collect::<Vec<_>>());
        let words = clock.words();
        assert_eq!(words[place_of::<Clock>("left")], place_of::<Clock>("left") as u32);
        assert_eq!(words[place_of::<Clock>("running")], 1, "a number that is not zero is true");
        let bounds = place_of::<Clock>("bounds");
        assert_eq!(words[bounds + 11], bounds as u32 + 11);
        assert_eq!(Clock::take(&words), clock);
    }

    #[test]
    fn shaders_have_the_bits_of_constants() {
        let module = parsed(&DECLARATIONS);
        let mut seen = Vec::new();
        for constant in constants() {
            assert!(!seen.contains(&constant.name), "{} stands twice", constant.name);
            seen.push(constant.name);
            if let Some(expected) = constant.value.bits() {
                assert_eq!(bits(&module, constant.name), Some(expected), "{}", constant.name);
            }
        }
        assert_eq!(bits(&module, "BOUND_BODY_SPEED"), Some(Bound::BodySpeed as u32));
        assert_eq!(bits(&module, "SOLVER_XPBD_NEO_HOOKEAN"), Some(Solver::XpbdNeoHookean as u32));
        // The controls.
        assert_eq!(bits(&module, "BOUND_NO_SUCH"), None);
        assert_eq!(bits(&parsed("const ONE: f32 = 1.0000001;"), "ONE"), Some(1.0_f32.to_bits() + 1));
    }

    #[test]
    fn every_shader_can_be_parsed_with_the_declarations() {
        for shader in sorb_shaders::SHADERS.iter().chain(sorb_shaders::SUBGROUP_SHADERS) {
            parsed(&complete(shader.source));
        }
    }

    #[test]
    fn shaders_declare_no_constants() {
        let declares = |source: &str| source.lines().any(|line| line.trim_start().starts_with("const "));
        for shader in sorb_shaders::SHADERS.iter().chain(sorb_shaders::SUBGROUP_SHADERS) {
            assert!(!declares(shader.source), "{}: declare it in Rust, by `constants!`", shader.name);
        }
        // Negative control.
        assert!(declares("fn half() -> f32 {\n    const HALF: f32 = 0.5;\n    return HALF;\n}"));
    }
}
