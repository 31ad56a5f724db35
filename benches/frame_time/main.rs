//! Figure 3 of the paper: time of a frame over the numbers of particles and nodes, by view, on the CPU and on a GPU.
//!
//! `cargo bench -p sorb-validation --bench frame_time --features render,gpu -- --csv FILE --svg STEM`. The scene is `life` with
//! other spacings and lattices. Simulation and drawing are timed apart: medians of frames of 1/60 s and of pictures.
//!
//! `--particles 1000,8000`, `--nodes 250,1000`, `--views realistic,fast`, `--backends cpu,gpu`, `--size 1280x720`, `--frames 3`,
//! `--pictures 7` choose what is measured. `--passes` prints the times of the passes of the renderer on a GPU. `--read FILE,FILE` takes
//! rows of earlier runs first, on other machines as well; with `--backends none` nothing is measured.

#![expect(clippy::print_stdout, reason = "the figures are what it is for")]

mod diagram;
mod sweep;

use std::{error::Error, fs, path::Path};

use sorb::render::View;
use sweep::{Backend, Row, Setting, Sweep};

/// Particles of the first sweep, and nodes of the second one.
const PARTICLES: [u32; 6] = [1000, 4000, 8192, 32_000, 100_000, 1_000_000];
const NODES: [u32; 4] = [250, 1000, 4000, 16_000];
/// Nodes of the first sweep, and particles of the second one.
const FEW_NODES: u32 = 1000;
const FEW_PARTICLES: u32 = 4000;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let value = |flag: &str| words.iter().position(|word| word == flag).and_then(|at| words.get(at + 1));
    let numbers = |flag: &str, default: &[u32]| -> Result<Vec<u32>> {
        value(flag).map_or(Ok(default.to_vec()), |list| {
            list.split(',').filter(|word| !word.is_empty()).map(|word| Ok(word.parse()?)).collect()
        })
    };
    let number = |flag: &str, default: u32| -> Result<u32> {
        Ok(numbers(flag, &[default])?.first().copied().unwrap_or(default))
    };
    let views = value("--views").map_or("realistic,fast,particles", String::as_str);
    let (width, height) =
        value("--size").map_or(Some(("1280", "720")), |size| size.split_once('x')).ok_or("--size")?;
    let setting = Setting {
        views: View::ALL
            .into_iter()
            .filter(|view| views.split(',').any(|name| name == name_of(*view)))
            .collect(),
        size: (width.parse()?, height.parse()?),
        frames: number("--frames", 3)?,
        pictures: number("--pictures", 7)?,
        has_passes: words.iter().any(|word| word == "--passes"),
    };
    let backends = value("--backends").map_or("cpu,gpu", String::as_str);
    let (particles, nodes) = (numbers("--particles", &PARTICLES)?, numbers("--nodes", &NODES)?);
    let mut rows = Vec::new();
    for file in value("--read").into_iter().flat_map(|files| files.split(',')) {
        let text = fs::read_to_string(file)?;
        for line in text.lines().filter(|line| *line != Row::HEADER) {
            rows.push(line.parse::<Row>()?);
        }
    }
    println!("{}", Row::HEADER);
    for backend in
        Backend::ALL.into_iter().filter(|backend| backends.split(',').any(|name| name == backend.name()))
    {
        let by_particles = particles.iter().map(|count| (Sweep::Particles, *count, FEW_NODES));
        let by_nodes = nodes.iter().map(|count| (Sweep::Nodes, FEW_PARTICLES, *count));
        for (sweep, particles, nodes) in by_particles.chain(by_nodes) {
            match sweep::measure(sweep, (particles, nodes), backend, &setting) {
                Ok(found) => rows.extend(found.into_iter().inspect(|row| println!("{}", row.csv()))),
                Err(error) => println!("# {particles} particles, {nodes} nodes, {}: {error}", backend.name()),
            }
        }
    }
    if let Some(path) = value("--csv") {
        let lines: Vec<String> = rows.iter().map(Row::csv).collect();
        fs::write(path, format!("{}\n{}\n", Row::HEADER, lines.join("\n")))?;
    }
    if let Some(stem) = value("--svg") {
        for sweep in [Sweep::Particles, Sweep::Nodes] {
            let text = diagram::diagram(sweep, &rows)?;
            fs::write(Path::new(&format!("{stem}_{}.svg", sweep.name())), text)?;
        }
    }
    Ok(())
}

/// Name of a view on the command line.
fn name_of(view: View) -> String {
    format!("{view:?}").to_lowercase()
}
