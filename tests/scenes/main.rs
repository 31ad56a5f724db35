//! The scenes over ten simulated seconds: results are goldens, and statements of the paper are claims.
//!
//! At half the resolution of the paper, so that all of them run in a test. Claims are ranges and do not change when a golden
//! is written anew.

#[path = "../common/mod.rs"]
mod common;
mod run;

use common::Claims;
use run::{Run, Sample};
use sorb::{Measures, scene::Scene};

const RESOLUTION: f32 = 0.5;

fn absorbed(sample: &Sample) -> f64 {
    sample.measures.absorbed_mass
}

fn volume(sample: &Sample) -> f64 {
    sample.measures.sponge_volume
}

#[test]
fn standing() {
    /// Depth of the water at time zero [m].
    const POOL: f64 = 0.03;
    let scene = common::preset("standing", RESOLUTION);
    let run = Run::of(&scene, 10.0);
    let mut claims = run.claims();
    let (early, late) = (absorbed(run.at(0.1)), absorbed(run.at(2.0)));
    claims.claim(late > 1.3 * early, format!("absorbed: {early:.4} kg at 0.1 s, {late:.4} kg at 2 s"));
    let end = run.mean(9.0..10.0, absorbed);
    claims.claim(end > 0.98 * late, format!("absorbed: {late:.4} kg at 2 s, {end:.4} kg in the end"));
    let wicking = run.mean(9.0..10.0, |sample| sample.measures.wicking_height);
    claims.claim(wicking > 1.5 * POOL, format!("wicking height {wicking:.4} m, pool {POOL} m"));
    let bound = 0.02 * run.height;
    let start = run.start.sponge_centre;
    let sideways = |sample: &Sample| {
        let drift = sample.measures.sponge_centre - start;
        (drift.x * drift.x + drift.z * drift.z).sqrt()
    };
    let (_, drift) = run.range(0.0..10.0, sideways);
    claims.claim(drift < bound, format!("drifts {drift:.5} m sideways, bound {bound:.5} m"));
    let (low, high) = run.range(2.0..10.0, |sample| sample.measures.sponge_centre.y);
    claims.claim(high - low < bound, format!("hops {:.5} m, bound {bound:.5} m", high - low));
    let (_, lift) = run.range(0.2..10.0, |sample| sample.lowest);
    claims.claim(lift < bound, format!("its lowest node is {lift:.5} m above the floor, bound {bound:.5} m"));

    // Without suction the water only levels out.
    let dry = Run::of(&common::with(&scene, &["sponges[0].entry_pressure=0"]), 2.0);
    let without = dry.mean(1.5..2.0, |sample| sample.measures.wicking_height);
    claims.claim(without < POOL + 0.01, format!("wicking height {without:.4} m without suction"));
    claims.claim(
        without < 0.7 * wicking,
        format!("wicking height {without:.4} m without suction, {wicking:.4} m with"),
    );
    // Without the reaction the sponge does not carry the water that it holds: it floats and drifts.
    let floating = Run::of(&common::with(&scene, &["sponges[0].reaction=0"]), 2.0);
    let (_, lift) = floating.range(0.2..2.0, |sample| sample.lowest);
    claims.claim(
        lift > 2.0 * bound,
        format!("its lowest node is {lift:.5} m above the floor without reaction"),
    );
    let (_, drift) = floating.range(0.0..2.0, sideways);
    claims.claim(drift > bound, format!("drifts {drift:.5} m sideways without reaction"));
    run.finish(claims);
}

/// Water leaves as the volume falls, and more slowly at a hundredth of the permeability.
fn squeezed(
    (scene, length): (&Scene, f64),
    before: f64,
    smallest: std::ops::Range<f64>,
    compared: f64,
    claims: &mut Claims,
) -> Run {
    let run = Run::of(scene, length);
    *claims = run.claims();
    let (minimum, _) = run.range(smallest.clone(), volume);
    let full = volume(run.at(before));
    claims.claim(minimum < 0.9 * full, format!("volume: {full:.3e} m^3, then {minimum:.3e} m^3"));
    let moment =
        run.samples.iter().find(|sample| volume(sample) <= minimum && sample.measures.time >= smallest.start);
    let moment = moment.map_or(smallest.end, |sample| sample.measures.time);
    let (held, left) = (absorbed(run.at(before)), absorbed(run.at(moment)));
    claims.claim(
        left < 0.9 * held,
        format!(
            "absorbed: {held:.4} kg at {before} s, {left:.4} kg at {moment:.3} s when the volume is smallest"
        ),
    );
    let permeability = scene.sponges[0].permeability / 100.0;
    let tight = common::with(scene, &[&format!("sponges[0].permeability={permeability:e}")]);
    let tight = Run::of(&tight, compared);
    claims.claim(tight.broken.is_none(), format!("a hundredth of the permeability: {:?}", tight.broken));
    let (_, fastest) = tight.range(0.0..compared, |sample| sample.measures.maximum_speed);
    // A single node that a plate or a ball releases springs back about as fast as an elastic wave.
    let wave = f64::from(scene.sponges[0].young_modulus / scene.sponges[0].density).sqrt();
    claims.claim(
        fastest < 1.5 * wave,
        format!("a hundredth of the permeability: something moves at {fastest:.1} m/s"),
    );
    // Loss against what each run holds when the compression begins; a mean over a bounce of the ball.
    let lost = |run: &Run| absorbed(run.at(before)) - run.mean(compared - 0.2..compared, absorbed);
    let (fast, slow) = (lost(&run), lost(&tight));
    claims.claim(
        slow < 0.95 * fast,
        format!("pressed out by {compared} s: {fast:.4} kg, {slow:.4} kg at a hundredth of the permeability"),
    );
    run
}

#[test]
fn ball_drop() {
    let mut claims = Claims::default();
    // At half the resolution the sponge would be two cells high. The ball is in the air for 0.12 s and goes deepest after
    // its first bounce.
    let scene = common::preset("ball_drop", 0.8);
    let run = squeezed((&scene, 3.0), 0.1, 0.1..0.6, 0.6, &mut claims);
    let early = absorbed(run.at(0.1));
    let (minimum, _) = run.range(0.1..0.22, absorbed);
    let (_, again) = run.range(0.22..0.5, absorbed);
    // At least as much as the pores become smaller: 12 %.
    let solid = (1.0 - f64::from(scene.sponges[0].porosity)) * run.start.sponge_volume;
    let (smallest, _) = run.range(0.1..0.22, volume);
    let pores = (smallest - solid) / (volume(run.at(0.1)) - solid);
    claims.claim(
        minimum < pores * early && pores < 0.9 && again > 1.04 * minimum,
        format!(
            "absorbed: {early:.4} kg, {minimum:.4} kg under the ball, {again:.4} kg when it has bounced; pores {pores:.3}"
        ),
    );
    let height = run.bodies[0];
    claims.claim(
        height > 0.05,
        format!("the ball stays in its dent: its centre is at {height:.3} m in the end"),
    );
    run.finish(claims);
}

#[test]
fn squish() {
    let mut claims = Claims::default();
    // The plates close from 0.3 s to 0.8 s, touch at 0.4 s, and open from 2 s to 2.5 s.
    let run = squeezed((&common::preset("squish", RESOLUTION), 10.0), 0.4, 0.7..0.85, 1.5, &mut claims);
    let closed = volume(run.at(1.0));
    let opened = run.mean(9.0..10.0, volume);
    claims.claim(
        opened > 1.3 * closed,
        format!("volume: {closed:.3e} m^3 closed, {opened:.3e} m^3 opened again"),
    );
    run.finish(claims);
}

#[test]
fn dam_break() {
    let scene = common::preset("dam_break", RESOLUTION);
    let run = Run::of(&scene, 10.0);
    let mut claims = run.claims();
    let moved = run.at(1.0).measures.sponge_centre.x - run.start.sponge_centre.x;
    claims.claim(moved > 0.02, format!("the flow carries the sponge by {moved:.4} m"));
    let (early, late) = (absorbed(run.at(1.0)), absorbed(run.at(5.0)));
    claims.claim(late > early && early > 0.0, format!("absorbed: {early:.4} kg, then {late:.4} kg"));
    // A sponge without drag and suction stays behind.
    let loose = ["sponges[0].permeability=1e-5", "sponges[0].entry_pressure=0"];
    let loose = Run::of(&common::with(&scene, &loose), 1.0);
    let stays = loose.at(1.0).measures.sponge_centre.x - loose.start.sponge_centre.x;
    claims.claim(stays < 0.5 * moved, format!("moves {moved:.4} m, and {stays:.4} m without coupling"));
    run.finish(claims);
}

#[test]
fn wring() {
    let scene = common::preset("wring", RESOLUTION);
    let run = Run::of(&scene, 6.0);
    let mut claims = run.claims();
    let full = volume(run.at(0.3));
    let (minimum, _) = run.range(0.3..6.0, volume);
    // Spun dry, the pores have no suction any more.
    let kept = volume(run.at(2.0));
    claims.claim(minimum < 0.9 * full, format!("volume: {full:.3e} m^3, then {minimum:.3e} m^3"));
    claims.claim(kept < 0.9 * full, format!("volume: {full:.3e} m^3, and {kept:.3e} m^3 while twisted"));
    let (held, left) = (absorbed(run.at(0.3)), absorbed(run.at(2.8)));
    claims.claim(left < 0.9 * held, format!("absorbed: {held:.4} kg at 0.3 s, {left:.4} kg at 2.8 s"));
    // Water that drips without twist: the same bar, not twisted.
    let still = Run::of(&common::with(&scene, &["bodies[0].motions=[]", "bodies[1].motions=[]"]), 2.8);
    let drips = absorbed(still.at(0.3)) - absorbed(still.at(2.8));
    claims.claim(
        held - left > 1.1 * drips,
        format!("lost from 0.3 s to 2.8 s: {:.4} kg twisted, {drips:.4} kg not twisted", held - left),
    );
    // Water on the floor splashes to the walls in both; the difference is in the air.
    let spread = |run: &Run| run.mean(0.8..2.8, |sample| sample.spread);
    let (wrung, hanging) = (spread(&run), spread(&still));
    claims.claim(
        wrung > 1.1 * hanging,
        format!("water in the air is {wrung:.4} m from the axis on average, {hanging:.4} m if not twisted"),
    );
    run.finish(claims);
}

#[test]
fn wipe() {
    let scene = common::preset("wipe", RESOLUTION);
    let run = Run::of(&scene, 4.0);
    let mut claims = run.claims();
    // The sponge is on its way from 0.6 s to 2.6 s, and in the air from 3.4 s on.
    let share = |run: &Run, time: f64| absorbed(run.at(time)) / run.at(time).measures.water_mass;
    let (moved, early, late) =
        (run.at(3.5).measures.sponge_centre - run.start.sponge_centre, share(&run, 0.6), share(&run, 4.0));
    claims.claim(moved.x > 0.2 && moved.y > 0.02, format!("wipes and is lifted: moves by {moved:?}"));
    claims.claim(
        early < 0.4 && late > 0.9,
        format!("holds {early:.3} of the water before its way, {late:.3} in the end"),
    );
    // Without suction it pushes the water aside.
    let smooth = Run::of(&common::with(&scene, &["sponges[0].entry_pressure=0"]), 4.0);
    let without = share(&smooth, 4.0);
    claims.claim(without < 0.8 * late, format!("holds {without:.3} in the end without suction"));
    run.finish(claims);
}

#[test]
fn stack() {
    let scene = common::preset("stack", RESOLUTION);
    let run = Run::of(&scene, 3.0);
    let mut claims = run.claims();
    let (full, small, again) = (volume(run.at(0.25)), volume(run.at(1.2)), volume(run.at(3.0)));
    claims.claim(small < 0.75 * full, format!("volume: {full:.3e} m^3, pressed {small:.3e} m^3"));
    claims.claim(again > 0.95 * full, format!("volume: {full:.3e} m^3, {again:.3e} m^3 in the end"));
    let centre = |time: f64| run.at(time).measures.sponge_centre;
    let (start, end) = (centre(0.25), centre(3.0));
    claims.claim(end.y > 0.95 * start.y, format!("the upper one lies on the lower one: {start:?}, {end:?}"));
    let aside = (end - start).length();
    claims.claim(aside < 0.005, format!("{start:?}, {end:?} in the end"));
    let (held, left) = (absorbed(run.at(0.25)), absorbed(run.at(1.2)));
    claims.claim(left < 0.95 * held, format!("absorbed: {held:.4} kg, {left:.4} kg pressed"));
    run.finish(claims);
}

#[test]
fn life() {
    // At half the resolution the sponge would be two cells high.
    let scene = common::preset("life", 0.75);
    let run = Run::of(&scene, 8.0);
    let mut claims = run.claims();
    let height = |time: f64| run.at(time).measures.sponge_centre.y;
    // It is in the air for 0.05 s, floats, and sinks as it absorbs water; the ball is down from 4 s to 4.5 s.
    let (early, late) = (absorbed(run.at(0.1)), absorbed(run.at(3.0)));
    claims.claim(late > 1.3 * early, format!("absorbed: {early:.4} kg at 0.1 s, {late:.4} kg at 3 s"));
    claims.claim(height(3.0) > 0.3 * height(0.0), format!("lies on the floor: {:.4} m", height(3.0)));
    let (low, high) = run.range(2.5..3.0, |sample| sample.measures.sponge_centre.y);
    claims.claim(high - low < 0.002, format!("moves by {:.5} m while it floats", high - low));
    let squeezed = absorbed(run.at(4.4));
    claims.claim(squeezed < 0.85 * late, format!("absorbed: {late:.4} kg at 3 s, {squeezed:.4} kg squeezed"));
    let (full, small) = (volume(run.at(3.0)), volume(run.at(4.4)));
    claims.claim(small < 0.85 * full, format!("volume: {full:.3e} m^3, squeezed {small:.3e} m^3"));
    let again = run.mean(7.5..8.0, absorbed);
    claims.claim(again > 0.9 * late, format!("absorbed: {late:.4} kg at 3 s, {again:.4} kg in the end"));
    let sideways = |sample: &Sample| {
        let drift = sample.measures.sponge_centre - run.start.sponge_centre;
        (drift.x * drift.x + drift.z * drift.z).sqrt()
    };
    let (_, drift) = run.range(0.0..8.0, sideways);
    // Water that flows holds nothing in place: less than an edge of the lattice.
    claims.claim(drift < 0.01, format!("drifts {drift:.5} m sideways"));
    // What does not drink floats higher, and gives nothing back.
    let tight = Run::of(&common::with(&scene, &["sponges[0].entry_pressure=0"]), 3.0);
    let without = absorbed(tight.at(3.0));
    claims.claim(without < 0.9 * late, format!("absorbed: {without:.4} kg at 3 s without suction"));
    run.finish(claims);
}

#[test]
fn bobbing() {
    /// Bodies that float, in the order of the scene; those after them sink.
    const FLOATING: usize = 4;
    // At half the resolution a body is three particles across.
    let scene = common::preset("bobbing", 1.0);
    let run = Run::of(&scene, 2.0);
    let mut claims = run.claims();
    let fluid = scene.fluid.as_ref().map_or(0.0, |fluid| fluid.blocks[0].maximum.y);
    for (index, (body, height)) in scene.bodies.iter().zip(&run.bodies).enumerate() {
        let is_afloat = *height > 0.7 * fluid;
        claims.claim(is_afloat == (index < FLOATING), format!("{} at {height:.4} m after 2 s", body.name));
    }
    // An apple of stone sinks.
    let heavy = Run::of(&common::with(&scene, &["bodies.apple.density=2500"]), 0.6);
    claims.claim(heavy.bodies[1] < 0.5 * fluid, format!("an apple of stone at {:.4} m", heavy.bodies[1]));
    run.finish(claims);
}

#[test]
fn water() {
    let run = Run::of(&common::preset("water", RESOLUTION), 2.0);
    let mut claims = run.claims();
    let energy = |sample: &Sample| sample.measures.kinetic_energy + sample.measures.potential_energy;
    let (start, end) = (run.start.potential_energy, energy(run.at(2.0)));
    let (_, maximum) = run.range(0.0..2.0, energy);
    claims.claim(maximum < 1.02 * start, format!("energy: {start:.4} J, then up to {maximum:.4} J"));
    claims.claim(end < 0.8 * start, format!("energy: {start:.4} J, then {end:.4} J: the dam has not fallen"));
    let error = run.mean(0.5..2.0, |sample| sample.measures.mean_density_error);
    claims.claim(error < 0.01, format!("mean density error {error:.4}"));
    run.finish(claims);
}

#[test]
fn dry() {
    let run = Run::of(&common::preset("dry", RESOLUTION), 2.0);
    let mut claims = run.claims();
    let (minimum, _) = run.range(0.0..0.5, volume);
    let full = run.start.sponge_volume;
    claims.claim(minimum < 0.95 * full, format!("volume: {full:.3e} m^3, under the ball {minimum:.3e} m^3"));
    let energy = |sample: &Sample| {
        let m = &sample.measures;
        m.kinetic_energy + m.potential_energy + m.elastic_energy
    };
    let start = run.start.potential_energy;
    let (_, maximum) = run.range(0.0..2.0, energy);
    claims.claim(maximum < 1.02 * start, format!("energy: {start:.4} J, then up to {maximum:.4} J"));
    run.finish(claims);
}

#[test]
fn empty() {
    let run = Run::of(&common::preset("empty", RESOLUTION), 2.0);
    let mut claims = run.claims();
    let last = run.at(2.0).measures;
    claims.claim(last == Measures { time: last.time, ..Measures::default() }, format!("{last:?}"));
    run.finish(claims);
}
