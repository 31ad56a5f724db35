//! Scratch probe.
#![allow(missing_docs, clippy::print_stdout, reason = "scratch")]
use sorb::{
    Options, World, render,
    scene::{self, Scene},
};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = &args[1];
    let seconds: f64 = args[2].parse().unwrap();
    let mut scene: Scene = scene::preset(name).unwrap();
    for set in &args[3..] {
        if let Some(r) = set.strip_prefix("r=") {
            scene = scene.scaled(r.parse().unwrap()).unwrap()
        } else if !set.starts_with("pic") {
            scene.set(set).unwrap();
        }
    }
    let pics = args.iter().any(|a| a == "pic");
    let mut w = World::with_options(&scene, &Options { threads: Some(2), ..Options::default() }).unwrap();
    println!(
        "particles {} nodes {} tets {} c={} mu={}",
        w.particle_positions().len(),
        w.node_positions().len(),
        w.lattice().tets.len(),
        w.params().fluid.sound_speed,
        w.params().fluid.viscosity
    );
    if args.iter().any(|a| a == "pictrace") {
        let mut c = w.columns().clone();
        let cpu = w.cpu().clone();
        for l in w.plan().lines().iter().filter(|l| l.verdict == sorb::schedule::Verdict::Runs) {
            if let Some(k) = sorb::kernel::kernel(l.name) {
                cpu.enter(|| (k.cpu)(&cpu, w.params(), &mut c));
                println!(
                    "{} a {:?} x {:?} v {:?} rho {:?}",
                    l.name,
                    c.fluid.acceleration.first(),
                    c.fluid.position[0],
                    c.fluid.velocity[0],
                    c.fluid.density.first()
                );
            }
        }
        println!("{:?}", w.params());
    }
    let start = std::time::Instant::now();
    let frames = (seconds * 60.0) as u32;
    for frame in 0..=frames {
        if frame % (frames / 20).max(1) == 0 {
            let m = w.measures();
            println!(
                "t {:.3} abs {:.4}/{:.4} S {:.3} wick {:.4} vol {:.3e} c=({:.4},{:.4},{:.4}) KE {:.3e} PE {:.4} EE {:.3e} vmax {:.3} err {:.4}/{:.3} steps {} a {:?}",
                m.time,
                m.absorbed_mass,
                m.water_mass,
                m.saturation,
                m.wicking_height,
                m.sponge_volume,
                m.sponge_centre.x,
                m.sponge_centre.y,
                m.sponge_centre.z,
                m.kinetic_energy,
                m.potential_energy,
                m.elastic_energy,
                m.maximum_speed,
                m.mean_density_error,
                m.maximum_density_error,
                w.clock().steps,
                w.bodies().first().map(|b| b.state.position.to_array())
            );
        }
        if pics && frame % (frames / 8).max(1) == 0 {
            let cam = scene.viewpoint();
            let bodies: Vec<_> = w
                .bodies()
                .iter()
                .map(|b| render::DrawnBody {
                    shape: &b.shape,
                    state: b.state,
                    translucent: b.kind == sorb::body::BodyKind::Kinematic,
                })
                .collect();
            let wet: Vec<f32> = w.node_saturations().iter().map(|s| s.clamp(0.0, 1.0)).collect();
            let p = render::Picture {
                particles: w.particle_positions(),
                velocities: w.particle_velocities(),
                particle_radius: w.params().fluid.spacing * 0.5,
                nodes: w.node_positions(),
                wetness: &wet,
                triangles: &w.lattice().triangles,
                bodies: &bodies,
                container: match scene.domain {
                    scene::Domain::Box { minimum, maximum } => Some((minimum, maximum)),
                    _ => None,
                },
                ..Default::default()
            };
            let camera = render::Camera {
                eye: cam.eye,
                target: cam.target,
                up: sorb::glam::Vec3::Y,
                field_of_view: cam.field_of_view_degrees.to_radians(),
            };
            render::draw(&p, &camera, 640, 360)
                .write_png(format!("/tmp/pics/{name}_{:03}.png", frame))
                .unwrap();
        }
        if frame < frames {
            match w.advance_frame() {
                Ok(r) => {
                    if frame % (frames / 20).max(1) == 0 {
                        println!("   frame steps {} h {:.2e} {:?}", r.steps, r.shortest_step, r.bound);
                    }
                }
                Err(e) => {
                    println!("ERR {e}");
                    let f = &w.columns().fluid;
                    for i in 0..w.particle_positions().len() {
                        if !f.velocity[i][0].is_finite() || !f.density[i].is_finite() {
                            println!(
                                "{i} x{:?} v{:?} rho {} a {:?}",
                                f.position[i], f.velocity[i], f.density[i], f.acceleration[i]
                            );
                            let l: Vec<u32> = f.neighbors.of(i, f.id.len()).collect();
                            println!("{l:?}");
                            break;
                        }
                    }
                    break;
                }
            }
        }
    }
    let el = start.elapsed().as_secs_f64();
    println!(
        "wall {el:.2} s, {:.3} ms/step, {:.2} M particle-steps/s digest {:016x}",
        el * 1e3 / w.clock().steps as f64,
        w.clock().steps as f64 * w.particle_positions().len() as f64 / el / 1e6,
        w.digest()
    );
    for t in w.phase_times() {
        println!("{:28} {:8.4} ms x {} total {:.2}", t.name, t.median_ms(), t.calls, t.total_s);
    }
}
