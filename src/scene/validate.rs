//! Validation: every number in its range, and the rules between them.

use glam::Vec3;

use super::body_rules::body_rules;
use super::container::container_problems;
use super::error::{Defect, Problem};
use super::limits::{self, Row};
use super::number::{number_text, vector_text};
use super::{
    BlockShape, Coupling, CouplingWeights, Domain, Fluid, FluidSolver, GravityKey, MAXIMUM_NODES,
    MAXIMUM_PARTICLES, Scene, SceneError, ShapeKind, Solver, Sponge, VERSION, ViscosityForm,
};

/// Range of `edge / spacing`. Outside it water slips between the nodes, or nodes find no water.
const EDGE_OVER_SPACING: (f32, f32) = (1.0, 8.0);

impl Scene {
    /// Checks every range and rule.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with all problems. Rules between values are checked only once all values are in their ranges,
    /// so that no problem causes another.
    pub fn validate(&self) -> Result<(), SceneError> {
        let problems = self.problems();
        if problems.is_empty() {
            return Ok(());
        }
        Err(SceneError::Invalid { file: format!("scene {}", self.name), problems })
    }

    /// All problems of the scene; empty for a valid one.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        ranges(self, &mut problems);
        if problems.is_empty() {
            rules(self, &mut problems);
        }
        problems
    }
}

fn ranges(scene: &Scene, problems: &mut Vec<Problem>) {
    if scene.version != VERSION {
        let defect = Defect::Version { supported: VERSION };
        problems.push(Problem::new("version", scene.version.to_string(), defect));
    }
    check(scene, limits::SCENE, "", problems);
    problems.extend(GravityKey::problems(&scene.gravity_path, "gravity_path"));
    check(&scene.time, limits::TIME, "time.", problems);
    check(&scene.domain, limits::DOMAIN, "domain.", problems);
    problems.extend(container_problems(&scene.container.motions, "container.motions", scene));
    if let Some(fluid) = &scene.fluid {
        check(fluid, limits::FLUID, "fluid.", problems);
        for (index, block) in fluid.blocks.iter().enumerate() {
            check(block, limits::FLUID_BLOCK, &format!("fluid.blocks[{index}]."), problems);
            block.shape.ranges(&format!("fluid.blocks[{index}].shape"), problems);
        }
    }
    for (index, emitter) in scene.emitters.iter().enumerate() {
        problems.extend(emitter.problems(&format!("emitters[{index}].")));
    }
    for (index, drain) in scene.drains.iter().enumerate() {
        problems.extend(drain.problems(&format!("drains[{index}].")));
    }
    for (index, sponge) in scene.sponges.iter().enumerate() {
        check(sponge, limits::SPONGE, &format!("sponges[{index}]."), problems);
        sponge.shape.ranges(&format!("sponges[{index}].shape"), problems);
    }
    for (index, body) in scene.bodies.iter().enumerate() {
        check(body, limits::BODY, &format!("bodies[{index}]."), problems);
        check(&body.shape, limits::SHAPE, &format!("bodies[{index}].shape."), problems);
        if let ShapeKind::Mesh { mesh, .. } = &body.shape {
            check(mesh, limits::MESH, &format!("bodies[{index}].shape.mesh."), problems);
        }
        check(&body.rotation, limits::ROTATION, &format!("bodies[{index}].rotation."), problems);
        for (motion_index, motion) in body.motions.iter().enumerate() {
            let table = format!("bodies[{index}].motions[{motion_index}].");
            check(motion, limits::MOTION, &table, problems);
        }
    }
    if let Some(camera) = &scene.camera {
        check(camera, limits::CAMERA, "camera.", problems);
    }
}

/// Compares every number of one table with its range.
pub(super) fn check<T>(owner: &T, rows: &[Row<T>], table: &str, problems: &mut Vec<Problem>) {
    for Row { limit, field } in rows {
        let Some(numbers) = field(owner) else { continue };
        numbers.numbers(&format!("{table}{}", limit.field()), &mut |key, value| {
            if !limit.contains(value) {
                let (minimum, maximum, unit) = (limit.minimum, limit.maximum, limit.unit);
                let defect = Defect::OutOfRange { minimum, maximum, unit };
                problems.push(Problem::new(key, number_text(value), defect));
            }
        });
    }
}

fn rules(scene: &Scene, problems: &mut Vec<Problem>) {
    names(scene, problems);
    let time = &scene.time;
    if time.minimum_step > time.maximum_step {
        let rule = format!("must not be above `time.maximum_step` = {}", number_text(time.maximum_step));
        problems.push(Problem::rule("time.minimum_step", number_text(time.minimum_step), rule));
    }
    if let Domain::Box { minimum, maximum, .. } = scene.domain {
        ordered("domain", minimum, maximum, problems);
    }
    repeating(scene, problems);
    if let Some(fluid) = &scene.fluid {
        water(fluid, scene, problems);
    }
    let flows = [("emitters", scene.emitters.len()), ("drains", scene.drains.len())];
    for (key, count) in flows.into_iter().filter(|(_, count)| *count > 0 && scene.fluid.is_none()) {
        problems.push(Problem::rule(key, count.to_string(), "needs `fluid`, which may be without blocks"));
    }
    sponges(scene, problems);
    for (index, body) in scene.bodies.iter().enumerate() {
        body_rules(body, &format!("bodies[{index}]"), scene, problems);
    }
    if let Some(camera) = scene.camera.filter(|camera| camera.eye == camera.target) {
        problems.push(Problem::rule("camera.eye", vector_text(camera.eye), "must not be `camera.target`"));
    }
    sizes(scene, problems);
}

fn names(scene: &Scene, problems: &mut Vec<Problem>) {
    let mut seen: Vec<(&str, String)> = Vec::new();
    named("name", &scene.name, problems);
    let sponges = scene.sponges.iter().enumerate().map(|(i, s)| (format!("sponges[{i}].name"), &s.name));
    let bodies = scene.bodies.iter().enumerate().map(|(i, b)| (format!("bodies[{i}].name"), &b.name));
    for (key, name) in sponges.chain(bodies) {
        named(&key, name, problems);
        if let Some((_, first)) = seen.iter().find(|(other, _)| other == name) {
            problems.push(Problem::rule(&key, format!("{name:?}"), format!("already the name of `{first}`")));
        }
        seen.push((name, key));
    }
}

/// Names must be usable in keys and in file names.
fn named(key: &str, name: &str, problems: &mut Vec<Problem>) {
    let mut letters = name.chars();
    let starts = letters.next().is_some_and(|first| first.is_ascii_alphabetic());
    if !starts || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') || name.len() > 64 {
        let rule = "a name starts with a letter, goes on with letters, digits, `_` or `-`, and has at most 64 of them";
        problems.push(Problem::rule(key, format!("{name:?}"), rule));
    }
}

/// The lowest corner must be below the highest on every axis.
fn ordered(table: &str, minimum: Vec3, maximum: Vec3, problems: &mut Vec<Problem>) {
    if !minimum.cmplt(maximum).all() {
        let rule = format!("must be below `{table}.maximum` = {} on every axis", vector_text(maximum));
        problems.push(Problem::rule(format!("{table}.minimum"), vector_text(minimum), rule));
    }
}

/// Shortest period over twice the radius of the neighbour search: no particle may see another one twice. A thousandth is
/// more than rounding.
const SHORTEST_PERIOD: f32 = 1.001;

/// Rules of periodic axes.
fn repeating(scene: &Scene, problems: &mut Vec<Problem>) {
    let Domain::Box { minimum, maximum, periodic } = scene.domain else { return };
    if periodic.contains(&true) && !scene.sponges.is_empty() {
        let rule = "sponges have no periodic images: a scene with sponges must have walls on all sides";
        problems.push(Problem::rule("domain.periodic", format!("{periodic:?}"), rule));
    }
    let Some(fluid) = &scene.fluid else { return };
    let shortest = 2.0 * fluid.neighbor_radius();
    for axis in (0..3).filter(|axis| periodic[*axis]) {
        let period = (maximum - minimum)[axis];
        if period < SHORTEST_PERIOD * shortest && period > 0.0 {
            let rule = format!(
                "needs a box longer than {} m along this axis, twice the radius of the neighbour search; it is {} m",
                number_text(shortest),
                number_text(period)
            );
            problems.push(Problem::rule(format!("domain.periodic[{axis}]"), "true", rule));
        }
    }
}

/// A box that must be inside the container.
pub(super) fn inside(
    key: &str,
    low: Vec3,
    high: Vec3,
    slack: f32,
    scene: &Scene,
    problems: &mut Vec<Problem>,
) {
    let Domain::Box { minimum, maximum, .. } = scene.domain else {
        return;
    };
    let slack = Vec3::splat(slack);
    if low.cmplt(minimum - slack).any() || high.cmpgt(maximum + slack).any() {
        let extent = format!("(from {} to {})", vector_text(low), vector_text(high));
        let container = format!("{} to {}", vector_text(minimum), vector_text(maximum));
        problems.push(Problem::rule(key, extent, format!("must be inside the container {container}")));
    }
}

fn water(fluid: &Fluid, scene: &Scene, problems: &mut Vec<Problem>) {
    let is_paper = !scene.sponges.is_empty() && scene.coupling() == Coupling::Paper;
    if scene.fluid_solver() == Some(FluidSolver::Divergence) && is_paper {
        let rule =
            "has no `fluid.coupling` = \"paper\" (the default unless every sponge has `solver` = \"vbd\")";
        problems.push(Problem::rule("fluid.solver", "\"divergence\"", rule));
    }
    if fluid.coupling == Some(Coupling::Porous) && !scene.allows_porous() {
        let rule = "needs `fluid.solver` = \"divergence\", \"dfsph\" or \"pbf\", and `solver` = \"vbd\" of every sponge";
        problems.push(Problem::rule("fluid.coupling", "\"porous\"", rule));
    }
    if fluid.coupling_weights == Some(CouplingWeights::Barycentric) && !scene.allows_barycentric() {
        let rule = "needs `fluid.coupling` = \"porous\" and `fluid.solver` = \"divergence\"";
        problems.push(Problem::rule("fluid.coupling_weights", "\"barycentric\"", rule));
    }
    let is_wcsph = scene.fluid_solver() == Some(FluidSolver::Wcsph);
    if fluid.viscosity_form == Some(ViscosityForm::StrainRate) && is_wcsph {
        let rule = "needs a `fluid.solver` other than \"wcsph\"";
        problems.push(Problem::rule("fluid.viscosity_form", "\"strain_rate\"", rule));
    }
    if fluid.retention > 0.0 && scene.fluid_solver() != Some(FluidSolver::Divergence) {
        let rule = "needs `fluid.solver` = \"divergence\"";
        problems.push(Problem::rule("fluid.retention", fluid.retention.to_string(), rule));
    }
    // Corners are decimals, which f32 rounds: a thousandth of the spacing covers that.
    let slack = 1e-3 * fluid.spacing;
    for (index, block) in fluid.blocks.iter().enumerate() {
        let key = format!("fluid.blocks[{index}]");
        ordered(&key, block.minimum, block.maximum, problems);
        inside(&key, block.minimum, block.maximum, slack, scene, problems);
        block.seam_rules(&key, fluid.spacing, scene, problems);
        block.shape.rules(&format!("{key}.shape"), problems);
        for (other_index, other) in fluid.blocks.iter().enumerate().take(index) {
            if overlap((block.minimum, block.maximum), (other.minimum, other.maximum), slack) {
                let rule =
                    format!("overlaps `fluid.blocks[{other_index}]`; the water would start compressed");
                let corner = format!("{key}.minimum");
                problems.push(Problem::rule(corner, vector_text(block.minimum), rule));
            }
        }
    }
}

/// Whether two boxes share volume.
fn overlap(a: (Vec3, Vec3), b: (Vec3, Vec3), slack: f32) -> bool {
    let slack = Vec3::splat(slack);
    (a.0 + slack).cmplt(b.1).all() && (b.0 + slack).cmplt(a.1).all()
}

fn sponges(scene: &Scene, problems: &mut Vec<Problem>) {
    for (index, sponge) in scene.sponges.iter().enumerate().filter(|(_, sponge)| !sponge.is_removed()) {
        let table = format!("sponges[{index}]");
        let slack = 1e-3 * sponge.edge;
        inside(&table, sponge.position, sponge.maximum(), slack, scene, problems);
        match &scene.fluid {
            Some(fluid) => lattice_fits(sponge, fluid, &table, problems),
            None if sponge.saturation > 0.0 => {
                let rule = "a scene without `fluid` has no water to fill the pores";
                problems.push(Problem::rule(
                    format!("{table}.saturation"),
                    number_text(sponge.saturation),
                    rule,
                ));
            }
            None => {}
        }
        sponge.shape.rules(&format!("{table}.shape"), problems);
        wetting(sponge, &table, scene, problems);
        if sponge.self_contact && sponge.solver != Solver::Vbd {
            let rule = "needs `solver` = \"vbd\"";
            problems.push(Problem::rule(format!("{table}.self_contact"), "true", rule));
        }
        for (other_index, other) in scene.sponges.iter().enumerate().take(index) {
            let whole = sponge.shape == BlockShape::Block && other.shape == BlockShape::Block;
            let (a, b) = ((sponge.position, sponge.maximum()), (other.position, other.maximum()));
            if whole && !sponge.added && !other.added && overlap(a, b, slack) {
                let rule = format!("overlaps `sponges[{other_index}]`");
                problems.push(Problem::rule(format!("{table}.position"), vector_text(sponge.position), rule));
            }
        }
    }
}

/// Rules of properties that depend on wetness.
fn wetting(sponge: &Sponge, table: &str, scene: &Scene, problems: &mut Vec<Problem>) {
    let (receding, entry) = (sponge.receding_pressure, sponge.entry_pressure);
    if receding > 0.0 && receding < entry {
        let rule = format!("must be 0 or not below `{table}.entry_pressure` = {}", number_text(entry));
        problems.push(Problem::rule(format!("{table}.receding_pressure"), number_text(receding), rule));
    }
    let is_modelled = match scene.fluid {
        Some(_) => scene.coupling() == Coupling::Porous,
        // Without water nothing becomes wet, but keys that would be invalid with water are a mistake.
        None => sponge.solver == Solver::Vbd,
    };
    if sponge.depends_on_wetness() && !is_modelled {
        let exponent = sponge.relative_permeability_exponent as f32;
        let asked = [
            ("softening", sponge.softening, 0.0),
            ("swelling", sponge.swelling, 0.0),
            ("relative_permeability_exponent", exponent, 1.0),
            ("receding_pressure", receding, entry),
        ];
        for (key, value, off) in asked.into_iter().filter(|(_, value, off)| value > off) {
            let rule = "needs `fluid.coupling` = \"porous\" and `solver` = \"vbd\"";
            let off = number_text(off);
            let rule = format!("{rule}; {off} turns it off");
            problems.push(Problem::rule(format!("{table}.{key}"), number_text(value), rule));
        }
    }
}

fn lattice_fits(sponge: &Sponge, fluid: &Fluid, table: &str, problems: &mut Vec<Problem>) {
    let (minimum, maximum) = EDGE_OVER_SPACING;
    let ratio = sponge.edge / fluid.spacing;
    // A thousandth covers the rounding of decimals.
    if !(0.999 * minimum..=1.001 * maximum).contains(&ratio) {
        let spacing = number_text(fluid.spacing);
        let rule = format!("must be {minimum} to {maximum} times `fluid.spacing` = {spacing}");
        problems.push(Problem::rule(format!("{table}.edge"), number_text(sponge.edge), rule));
    }
}

fn sizes(scene: &Scene, problems: &mut Vec<Problem>) {
    let estimate = scene.estimate();
    if estimate.particles > MAXIMUM_PARTICLES {
        let spacing = scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        let rule = format!("gives about {} particles; at most {MAXIMUM_PARTICLES}", estimate.particles);
        problems.push(Problem::rule("fluid.spacing", number_text(spacing), rule));
    }
    if estimate.nodes > MAXIMUM_NODES {
        let rule = format!("have about {} nodes; at most {MAXIMUM_NODES}", estimate.nodes);
        problems.push(Problem::rule("sponges", format!("({} sponges)", scene.sponges.len()), rule));
    }
}
