//! Sponges that fall, float, sink, drink, drip and share.

use sorb::{
    glam::{UVec3, Vec3},
    scene::{Body, Motion, Scene, ShapeKind, Sponge},
};

use super::{Expectation, GRAVITY, advance, after, all, mean_height, mean_over, pool, reach, tank};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::mean,
};

pub(in crate::cases) static CASE: Case = Case {
    name: "everyday_sponges",
    title: "what anybody would try first with sponges",
    source: "free fall, weight, Archimedes, the volume of pores, Hooke",
    subject: Subject::Coupling,
    control: "gravity of 6 m/s^2",
    run,
};

const EXPECTATIONS: &[Expectation] = &[
    (true, sponge_falls),
    (true, dent_doubles),
    (true, sponge_springs_back),
    (false, floor_holds),
    (true, wet_sponge_weighs),
    (true, lifted_sponge_keeps_its_water),
    (true, heavy_sponge_sinks),
    (false, light_sponge_floats),
    (false, puddle_is_drunk),
    (false, honey_is_not_drunk),
    (false, squeezed_harder_drips_more),
    (false, sponges_share),
    (false, ball_stays_on_top),
];

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    all(setting, EXPECTATIONS)
}

/// A sponge of some cells of a centimetre, with the middle of its lower face above the origin \[m\].
fn sponge(setting: &Setting, cells: [u32; 3], height: f32) -> Sponge {
    let edge = (0.01 / setting.resolution) as f32;
    let cells = UVec3::from_array(cells.map(|count| setting.count(count)));
    let size = cells.as_vec3() * edge;
    Sponge { edge, cells, ..Sponge::new("sponge", Vec3::new(-0.5 * size.x, height, -0.5 * size.z)) }
}

/// A container without water, large enough not to be touched beside its floor.
fn room(setting: &Setting) -> Scene {
    tank(setting, (0.12, 0.4), Vec::new())
}

fn sponge_falls(setting: &Setting) -> Result<Figure, Failure> {
    let mut world = setting.world(&room(setting).with_sponge(sponge(setting, [4, 4, 4], 0.2)))?;
    let start = mean_height(world.node_positions());
    advance(setting, &mut world, 0.15, |_| ())?;
    let due = 0.5 * GRAVITY * world.clock().time.powi(2);
    let fallen = start - mean_height(world.node_positions());
    // Semi-implicit steps are ahead by half a step, of 4 ms at most.
    Ok(Figure::relative("a sponge falls for 0.15 s", "m", due, fallen, 0.03))
}

/// Height of a sponge under a plate of its width and of some mass \[kg\], at rest.
fn height_under(setting: &Setting, mass: f64) -> Result<f64, Failure> {
    let own =
        Sponge { poisson_ratio: 0.0, young_modulus: 1e4, damping: 0.01, ..sponge(setting, [6, 6, 6], 0.0) };
    let half_extents = Vec3::new(0.04, 0.01, 0.04);
    let density = (mass / (0.08 * 0.08 * 0.02)) as f32;
    let plate = Body::dynamic("plate", ShapeKind::Cuboid { half_extents }, Vec3::Y * 0.071, density);
    let mut world = setting.world(&room(setting).with_sponge(own).with_body(plate))?;
    mean_over(setting, &mut world, (1.5, 2.0), |world| f64::from(world.bodies()[0].state.position.y) - 0.01)
}

/// Weight over modulus and area.
fn dent_doubles(setting: &Setting) -> Result<Figure, Failure> {
    let (light, heavy) = (height_under(setting, 0.1)?, height_under(setting, 0.3)?);
    let due = 0.2 * GRAVITY / (1e4 * 0.06 * 0.06) * 0.06;
    Ok(Figure::relative("further dent of a sponge by 0.2 kg", "m", due, light - heavy, 0.1))
}

/// A plate presses a dry sponge to half its height, and lets it go.
fn sponge_springs_back(setting: &Setting) -> Result<Figure, Failure> {
    let move_by = |velocity: f32, start: f32| Motion::Linear {
        velocity: Vec3::Y * velocity,
        start,
        end: start + 0.4,
        ease: 0.1,
    };
    let half_extents = Vec3::new(0.05, 0.01, 0.05);
    let motions = vec![move_by(-0.1, 0.1), move_by(0.2, 0.6)];
    let plate = Body::kinematic("plate", ShapeKind::Cuboid { half_extents }, Vec3::Y * 0.071, motions);
    let scene = room(setting).with_sponge(sponge(setting, [6, 6, 6], 0.0)).with_body(plate);
    let mut world = setting.world(&scene)?;
    let (_, before) = reach(world.node_positions());
    let mut lowest = f64::INFINITY;
    advance(setting, &mut world, 2.0, |world| lowest = lowest.min(reach(world.node_positions()).1))?;
    if lowest > 0.6 * before {
        return Err(Failure::Nothing(format!("the plate pressed it to {lowest} m only")));
    }
    let after = reach(world.node_positions()).1;
    Ok(Figure::relative("height of a sponge after it was pressed to half", "m", before, after, 0.02))
}

/// Dropped from 20 cm, no node goes through the floor.
fn floor_holds(setting: &Setting) -> Result<Figure, Failure> {
    let mut world = setting.world(&room(setting).with_sponge(sponge(setting, [4, 4, 4], 0.2)))?;
    let mut lowest = f64::INFINITY;
    advance(setting, &mut world, 1.0, |world| lowest = lowest.min(reach(world.node_positions()).0))?;
    Ok(Figure::error("how far a sponge goes into the floor from 20 cm", "m", (-lowest).max(0.0), 2e-4))
}

/// A soaked sponge on a plate pushes it down by its weight and that of its water.
fn wet_sponge_weighs(setting: &Setting) -> Result<Figure, Failure> {
    let own = Sponge { saturation: 0.7, entry_pressure: 1000.0, ..sponge(setting, [5, 4, 5], 0.05) };
    let plate = ShapeKind::Cuboid { half_extents: Vec3::new(0.06, 0.01, 0.06) };
    let scene = room(setting).with_sponge(own).with_body(Body::fixed("plate", plate, Vec3::Y * 0.04));
    let mut world = setting.world(&scene)?;
    let force = mean_over(setting, &mut world, (0.5, 1.0), |world| {
        let loads = world.body_loads()[0];
        -(loads.fluid.force.y + loads.sponges.force.y)
    })?;
    let dry: f64 = world.node_masses().iter().map(|mass| f64::from(*mass)).sum();
    let weight = GRAVITY * (dry + world.measures().water_mass);
    Ok(Figure::relative("weight of a wet sponge on a plate", "N", weight, force, 0.03))
}

/// A soaked sponge of 4 cm, held at its top, keeps what 10 cm of suction hold. A layer of particles hangs below it.
fn lifted_sponge_keeps_its_water(setting: &Setting) -> Result<Figure, Failure> {
    let own = Sponge { saturation: 1.0, entry_pressure: 1000.0, ..sponge(setting, [5, 4, 5], 0.1) };
    let half_extents = Vec3::new(0.04, 0.01, 0.04);
    let hand =
        Body { grip: true, ..Body::fixed("hand", ShapeKind::Cuboid { half_extents }, Vec3::Y * 0.149) };
    let scene = room(setting).with_sponge(own).with_body(hand);
    let mut world = setting.world(&scene)?;
    setting.advance(&mut world)?;
    let before = world.measures().absorbed_mass;
    advance(setting, &mut world, 1.0, |_| ())?;
    let held = world.measures().absorbed_mass / before;
    Ok(Figure::relative("share of its water that a sponge keeps in the air for 1 s", "1", 1.0, held, 0.2))
}

/// Material of twice the density of water: soaked, 1100 kg/m^3.
fn heavy_sponge_sinks(setting: &Setting) -> Result<Figure, Failure> {
    let own = Sponge { density: 200.0, saturation: 1.0, ..sponge(setting, [4, 4, 4], 0.07) };
    let scene = tank(setting, (0.06, 0.16), pool(0.06, 0.06)).with_sponge(own);
    let world = after(setting, &scene, 1.5)?;
    let lowest = reach(world.node_positions()).0;
    Ok(Figure::error("height of a soaked sponge of 1100 kg/m^3 above the floor", "m", lowest, 2e-3))
}

/// Material of half the density of water: soaked, 950 kg/m^3.
fn light_sponge_floats(setting: &Setting) -> Result<Figure, Failure> {
    let own = Sponge { density: 50.0, saturation: 1.0, ..sponge(setting, [4, 4, 4], 0.07) };
    let scene = tank(setting, (0.08, 0.16), pool(0.08, 0.06)).with_sponge(own);
    let mut world = setting.world(&scene)?;
    let deep = mean_over(setting, &mut world, (2.0, 3.0), |world| {
        let corners = [(-0.06, -0.06), (0.06, -0.06), (-0.06, 0.06), (0.06, 0.06)];
        (mean(heights(world, &corners)) - reach(world.node_positions()).0) / 0.04
    })?;
    Ok(Figure::relative("draft of a soaked sponge of 950 kg/m^3 over its height", "1", 0.95, deep, 0.12))
}

/// A sponge of 6 cm on 5 mm of water drinks most of it.
fn puddle_is_drunk(setting: &Setting) -> Result<Figure, Failure> {
    let own = Sponge { permeability: 4e-9, ..sponge(setting, [6, 6, 6], 0.006) };
    let scene = tank(setting, (0.04, 0.12), pool(0.04, 0.005)).with_sponge(own);
    let world = after(setting, &scene, 3.0)?;
    let measures = world.measures();
    let left = 1.0 - measures.absorbed_mass / measures.water_mass;
    Ok(Figure::error("share of a puddle that a sponge leaves after 3 s", "1", left, 0.2))
}

/// Honey of 10 Pa s enters ten thousand times as slowly as water.
fn honey_is_not_drunk(setting: &Setting) -> Result<Figure, Failure> {
    let absorbed = |viscosity: f32| -> Result<f64, Failure> {
        let mut scene =
            tank(setting, (0.05, 0.12), pool(0.05, 0.02)).with_sponge(sponge(setting, [4, 4, 4], 0.021));
        if let Some(fluid) = &mut scene.fluid {
            fluid.viscosity = viscosity;
        }
        Ok(after(setting, &scene, 0.5)?.measures().absorbed_mass)
    };
    let ratio = absorbed(10.0)? / absorbed(0.001)?;
    Ok(Figure::error("honey that a sponge drinks in 0.5 s, over water", "1", ratio, 0.1))
}

/// Pressed to 0.6 and 0.4 of its height a sponge has pores of 0.5 and 0.3 of its volume left.
fn squeezed_harder_drips_more(setting: &Setting) -> Result<Figure, Failure> {
    let expelled = |height: f32| -> Result<f64, Failure> {
        let own = Sponge { saturation: 1.0, permeability: 1e-8, ..sponge(setting, [5, 5, 5], 0.0) };
        let way = 0.05 * (1.0 - height);
        let press = Motion::Linear { velocity: Vec3::NEG_Y * way, start: 0.2, end: 1.3, ease: 0.1 };
        let half_extents = Vec3::new(0.06, 0.01, 0.06);
        let plate = ShapeKind::Cuboid { half_extents };
        let plate = Body::kinematic("plate", plate, Vec3::Y * 0.0605, vec![press]);
        let scene = tank(setting, (0.1, 0.12), Vec::new()).with_sponge(own).with_body(plate);
        let world = after(setting, &scene, 2.0)?;
        let measures = world.measures();
        Ok(1.0 - measures.absorbed_mass / measures.water_mass)
    };
    let ratio = expelled(0.4)? / expelled(0.6)?;
    Ok(Figure::relative("water pressed out to 0.4 of the height, over that to 0.6", "1", 1.5, ratio, 0.2))
}

/// A wet sponge on a dry one of its kind.
fn sponges_share(setting: &Setting) -> Result<Figure, Failure> {
    let own = |name: &str, saturation: f32, height: f32| Sponge {
        name: name.to_owned(),
        saturation,
        permeability: 4e-9,
        ..sponge(setting, [5, 3, 5], height)
    };
    let scene = room(setting).with_sponge(own("dry", 0.0, 0.0)).with_sponge(own("wet", 0.8, 0.0305));
    let world = after(setting, &scene, 3.0)?;
    let saturation = |sponge: u32| {
        let rows = world.node_saturations().iter().zip(&world.lattice().node_sponge);
        let own: Vec<f64> =
            rows.filter(|(_, of)| **of == sponge).map(|(value, _)| f64::from(*value)).collect();
        mean(own)
    };
    let ratio = saturation(0) / saturation(1);
    Ok(Figure::error(
        "saturation of a sponge under a wet one after 3 s, lack over that",
        "1",
        (1.0 - ratio).max(0.0),
        0.2,
    ))
}

/// A ball that is put in the middle of a sponge stays there. It rolls by 7 mm, from a node into the middle of four.
fn ball_stays_on_top(setting: &Setting) -> Result<Figure, Failure> {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::Y * 0.066, 2000.0);
    let scene = room(setting).with_sponge(sponge(setting, [6, 5, 6], 0.0)).with_body(ball);
    let world = after(setting, &scene, 2.0)?;
    let off = f64::from(world.bodies()[0].state.position.with_y(0.0).length());
    let is_up = world.bodies()[0].state.position.y > 0.04;
    Ok(Figure::error(
        "way of a ball from the middle of a sponge in 2 s",
        "m",
        if is_up { off } else { f64::NAN },
        1e-2,
    ))
}
