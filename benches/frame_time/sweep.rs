//! What is measured.

use std::{hint::black_box, str::FromStr, sync::Arc, time::Instant};

use sorb::{
    Offload, Options, World,
    gpu::{Gpu, wgpu},
    render::{Camera, Renderer, View, draw_world},
    scene::{self, Scene},
};

use super::{Result, name_of};

/// Which number differs from row to row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sweep {
    Particles,
    Nodes,
}

impl Sweep {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Particles => "particles",
            Self::Nodes => "nodes",
        }
    }
}

/// What simulates and draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Backend {
    Cpu,
    Gpu,
}

impl Backend {
    pub(super) const ALL: [Self; 2] = [Self::Cpu, Self::Gpu];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }
}

/// How it is measured.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    pub(super) views: Vec<View>,
    pub(super) size: (u32, u32),
    pub(super) frames: u32,
    pub(super) pictures: u32,
    pub(super) has_passes: bool,
}

/// A measurement: medians in milliseconds.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) sweep: Sweep,
    pub(super) backend: Backend,
    pub(super) adapter: String,
    pub(super) particles: usize,
    pub(super) nodes: usize,
    pub(super) view: View,
    pub(super) simulation: f64,
    /// On a GPU until the picture is in its memory.
    pub(super) drawing: f64,
}

impl Row {
    pub(super) const HEADER: &str = "sweep,backend,adapter,particles,nodes,view,simulation_ms,drawing_ms";

    pub(super) fn csv(&self) -> String {
        let Self { sweep, backend, adapter, particles, nodes, view, simulation, drawing } = self;
        let (sweep, backend, view) = (sweep.name(), backend.name(), name_of(*view));
        format!("{sweep},{backend},{adapter},{particles},{nodes},{view},{simulation:.3},{drawing:.3}")
    }
}

impl FromStr for Row {
    type Err = String;

    fn from_str(line: &str) -> std::result::Result<Self, String> {
        let fields: Vec<&str> = line.split(',').collect();
        let [sweep, backend, adapter, particles, nodes, view, simulation, drawing] = fields[..] else {
            return Err(format!("{line:?} has {} fields, and not 8", fields.len()));
        };
        let number = |text: &str| text.parse::<f64>().map_err(|error| format!("{text:?}: {error}"));
        let unknown = |name: &str| format!("{line:?}: unknown {name}");
        let named = |sweep: &Sweep| sweep.name() == fields[0];
        let known = Backend::ALL.into_iter().find(|own| own.name() == backend);
        Ok(Self {
            sweep: [Sweep::Particles, Sweep::Nodes].into_iter().find(named).ok_or_else(|| unknown(sweep))?,
            backend: known.ok_or_else(|| unknown(backend))?,
            adapter: adapter.to_owned(),
            particles: number(particles)? as usize,
            nodes: number(nodes)? as usize,
            view: View::ALL.into_iter().find(|own| name_of(*own) == view).ok_or_else(|| unknown(view))?,
            simulation: number(simulation)?,
            drawing: number(drawing)?,
        })
    }
}

/// Water and a sponge with about so many particles and nodes.
fn scene(particles: u32, nodes: u32) -> Result<Scene> {
    let plain = scene::preset("life")?;
    // 8 x 5 x 8 cells have 990 nodes; a lattice has twice as many nodes as corners.
    let cells = (2..60_u32).min_by_key(|along| node_count(*along).abs_diff(nodes)).unwrap_or(8);
    let edge = 0.08 / cells as f32;
    let lattice = [cells, (0.05 / edge).round() as u32, cells];
    // Particles fill 0.16 x 0.07 x 0.16 m, or less: their spacing may not be longer than an edge of the lattice.
    let (area, count) = (0.16_f32 * 0.16, particles as f32);
    let spacing = (area * 0.07 / count).cbrt().min(edge);
    let depth = count * spacing * spacing * spacing / area;
    let keys = [
        format!("fluid.blocks=[{{minimum=[-0.08,0.0,-0.08],maximum=[0.08,{depth},0.08]}}]"),
        format!("fluid.spacing={spacing}"),
        format!("sponges.sponge.edge={edge}"),
        format!("sponges.sponge.cells={lattice:?}"),
    ];
    Ok(plain.with_overrides(keys.iter().map(String::as_str))?)
}

/// Nodes of a lattice of so many cells along a side.
fn node_count(along: u32) -> u32 {
    let across = (0.05 / 0.08 * along as f32).round() as u32;
    (along + 1) * (along + 1) * (across + 1) + along * along * across
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Milliseconds of some work.
fn timed(work: impl FnOnce() -> Result<()>) -> Result<f64> {
    let start = Instant::now();
    work()?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

fn wait(gpu: &Gpu) -> Result<()> {
    gpu.device().poll(wgpu::PollType::wait_indefinitely())?;
    Ok(())
}

/// All views of a scene.
pub(super) fn measure(
    sweep: Sweep,
    (particles, nodes): (u32, u32),
    backend: Backend,
    setting: &Setting,
) -> Result<Vec<Row>> {
    let gpu = if backend == Backend::Gpu { Some(Arc::new(Gpu::new()?)) } else { None };
    let offload = if backend == Backend::Gpu { Offload::Gpu } else { Offload::Cpu };
    let options = Options { offload, gpu: gpu.clone(), ..Options::default() };
    let mut world = World::with_options(&scene(particles, nodes)?, &options)?;
    let mut frames = Vec::new();
    for _ in 0..setting.frames {
        frames.push(timed(|| {
            world.advance_frame()?;
            gpu.as_deref().map_or(Ok(()), wait)
        })?);
    }
    // The first frame compiles.
    let simulation = median(frames.split_off(usize::from(frames.len() > 1)));
    let adapter = gpu.as_ref().map_or("-".to_owned(), |gpu| gpu.report().name.replace(',', " "));
    let mut renderer = gpu.as_ref().map(Renderer::new);
    let mut rows = Vec::new();
    for view in &setting.views {
        let drawing = drawing(&world, *view, renderer.as_mut(), setting)?;
        rows.push(Row {
            sweep,
            backend,
            adapter: adapter.clone(),
            particles: world.particle_count(),
            nodes: world.lattice().position.len(),
            view: *view,
            simulation,
            drawing,
        });
    }
    Ok(rows)
}

/// Median of the pictures of a view, without the first one, which compiles.
fn drawing(world: &World, view: View, renderer: Option<&mut Renderer>, setting: &Setting) -> Result<f64> {
    let camera: Camera = world.scene().viewpoint().into();
    let (width, height) = setting.size;
    let mut times = Vec::new();
    if let Some(renderer) = renderer {
        let gpu = Arc::clone(renderer.gpu());
        for _ in 0..=setting.pictures {
            times.push(timed(|| {
                renderer.frame_of_world(world, &camera, view, width, height)?;
                wait(&gpu)
            })?);
        }
        if setting.has_passes {
            renderer.take_times()?;
            renderer.frame_of_world(world, &camera, view, width, height)?;
            for (pass, milliseconds) in renderer.times() {
                println!("# {} {pass} {milliseconds:.3}", name_of(view));
            }
            renderer.forget_times();
        }
    } else {
        for _ in 0..=setting.pictures {
            times.push(timed(|| {
                black_box(draw_world(world, &camera, view, width, height));
                Ok(())
            })?);
        }
    }
    Ok(median(times.split_off(1)))
}
