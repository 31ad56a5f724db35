//! A host draws 144 pictures a second of a world that takes 60 frames a second: it draws between the last two frames.
// Prints: ^Ball sank [0-9]+ mm; [0-9]+ rows changed particles; at most [0-9.]+ m/s drawn$

use std::{collections::BTreeMap, mem};

use sorb::{
    World,
    glam::{Quat, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

/// What is drawn of a frame.
struct Picture {
    /// By identity: a row is another particle in every frame, because rows are sorted by place.
    particles: BTreeMap<u32, Vec3>,
    /// Poses of the bodies.
    bodies: Vec<(Vec3, Quat)>,
}

impl Picture {
    fn of(world: &World) -> Self {
        let places = world.particle_positions().iter().map(|[x, y, z, _]| Vec3::new(*x, *y, *z));
        Self {
            particles: world.particle_ids().iter().copied().zip(places).collect(),
            bodies: world.bodies().iter().map(|body| (body.state.position, body.state.rotation)).collect(),
        }
    }

    /// Between two frames: at a share of 0 the first, of 1 the second. What has just come is drawn where it is.
    fn between(&self, next: &Self, share: f32) -> Self {
        let place =
            |(id, to): (&u32, &Vec3)| (*id, self.particles.get(id).map_or(*to, |from| from.lerp(*to, share)));
        let pose = |(from, to): (&(Vec3, Quat), &(Vec3, Quat))| {
            (from.0.lerp(to.0, share), from.1.slerp(to.1, share))
        };
        Self {
            particles: next.particles.iter().map(place).collect(),
            bodies: self.bodies.iter().zip(&next.bodies).map(pose).collect(),
        }
    }

    /// The longest way of a particle to another picture \[m\].
    fn longest_way(&self, next: &Self) -> f32 {
        let ways = next.particles.iter().filter_map(|(id, to)| Some(self.particles.get(id)?.distance(*to)));
        ways.fold(0.0, f32::max)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (low, high) = (Vec3::new(-0.08, 0.0, -0.05), Vec3::new(0.08, 0.2, 0.05));
    let blocks = vec![FluidBlock::new(low, Vec3::new(0.08, 0.08, 0.05))];
    let fluid = Fluid { spacing: 0.008, blocks, ..Fluid::default() };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::new(0.0, 0.11, 0.0), 3000.0);
    let mut world = World::new(&Scene::new("drop").in_box(low, high).with_fluid(fluid).with_body(ball))?;

    let (frame, tick) = (1.0 / f64::from(world.scene().time.frame_rate), 1.0 / 144.0);
    let (mut last, mut next, mut drawn) = (Picture::of(&world), Picture::of(&world), Picture::of(&world));
    let (mut rest, mut longest, mut moved) = (0.0_f64, 0.0_f32, 0);
    for _ in 0..144 {
        // What the clock of the host says. If frames take longer than they last, the world lags and the host goes on.
        rest = (rest + tick).min(4.0 * frame);
        while rest >= frame {
            let before = world.particle_ids().to_vec();
            world.advance_frame()?;
            moved += before.iter().zip(world.particle_ids()).filter(|(id, own)| id != own).count();
            last = mem::replace(&mut next, Picture::of(&world));
            rest -= frame;
        }
        let picture = last.between(&next, (rest / frame) as f32);
        longest = longest.max(drawn.longest_way(&picture));
        drawn = picture;
    }
    let (speed, depth) = (144.0 * longest, 1e3 * (0.11 - drawn.bodies[0].0.y));
    assert!(moved > 1000 && speed < 5.0, "{moved} rows, {speed} m/s");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("Ball sank {depth:.0} mm; {moved} rows changed particles; at most {speed:.1} m/s drawn");
    }
    Ok(())
}
