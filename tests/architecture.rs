//! The figures of ARCHITECTURE.md are what the step is. `UPDATE_FIGURES=1 cargo test --test architecture` writes them anew.

use std::{fmt::Write as _, fs};

use sorb::internal::{
    HostPhase, POROUS_STEP, Phase, STEP, Solve, Times,
    columns::{Column, Store},
    need::Need,
};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/ARCHITECTURE.md");

/// Widths of the columns of a figure: names, what is read, what is written, what is needed.
const WIDTHS: [usize; 4] = [33, 42, 37, 26];

/// A figure in the making.
#[derive(Debug, Default)]
struct Figure {
    text: String,
    /// Blocks that are written out already.
    blocks: Vec<&'static str>,
}

impl Figure {
    fn begin(&mut self) {
        self.row(0, ["", "reads", "writes", "only with"].map(|title| vec![title.to_owned()]));
    }

    /// A row of cells, each of lines.
    fn row(&mut self, indent: usize, cells: [Vec<String>; 4]) {
        let height = cells.iter().map(Vec::len).max().unwrap_or(0);
        for index in 0..height {
            let mut line = " ".repeat(indent);
            let mut end = 0;
            for (cell, width) in cells.iter().zip(WIDTHS) {
                end += width;
                line.push_str(cell.get(index).map_or("", String::as_str));
                line.push_str(&" ".repeat(end.saturating_sub(line.len())));
            }
            writeln!(self.text, "{}", line.trim_end()).expect("a string takes all text");
        }
    }

    fn note(&mut self, indent: usize, note: &str) {
        self.row(indent, [vec![note.to_owned()], Vec::new(), Vec::new(), Vec::new()]);
    }

    fn phase(&mut self, indent: usize, name: &str, [reads, writes]: [&[Column]; 2], needs: &[Need]) {
        let needs: Vec<_> = needs.iter().filter_map(condition).collect();
        let cells = [
            vec![name.to_owned()],
            stores(reads, WIDTHS[1]),
            stores(writes, WIDTHS[2]),
            lines(needs.into_iter().map(|need| (need.clone(), need)), ", ", WIDTHS[3]),
        ];
        self.row(indent, cells);
    }

    fn phases(&mut self, indent: usize, phases: &[Phase]) {
        for phase in phases {
            match phase {
                Phase::Run(kernel) => {
                    self.phase(indent, kernel.name, [kernel.reads, kernel.writes], kernel.needs);
                }
                Phase::Host(HostPhase { name, needs, reads, writes }) => {
                    self.phase(indent, name, [reads, writes], needs);
                }
                Phase::Named(block) if self.blocks.contains(&block.name) => {
                    self.note(indent, &format!("{}, as above", block.name.to_uppercase()));
                }
                Phase::Named(block) => {
                    self.note(indent, &block.name.to_uppercase());
                    self.phases(indent + 2, block.phases);
                    self.blocks.push(block.name);
                }
                Phase::Repeat { times, phases } => {
                    self.note(indent, &repetition(*times));
                    self.phases(indent + 2, phases);
                }
                Phase::With { needs, phases } => {
                    let needs = needs.iter().filter_map(condition).collect::<Vec<_>>();
                    self.note(indent, &format!("with {}:", needs.join(", ")));
                    self.phases(indent + 2, phases);
                }
                Phase::KeepDensity { solve, divergence, projection } => {
                    self.phases(indent, solve);
                    self.note(indent, "or, with divergence:");
                    self.phases(indent + 2, divergence);
                    self.note(indent, "or, with pbf:");
                    self.phases(indent + 2, projection);
                }
            }
        }
    }
}

fn repetition(times: Times) -> String {
    match times {
        Times::SolverIterations => "as often as sponges[..].iterations says:".to_owned(),
        Times::Projections => "as often as fluid.projections says:".to_owned(),
        Times::Fixed(times) => format!("{times} times:"),
        Times::UntilConverged(Solve::Pressure) => "until the pressure has converged:".to_owned(),
        Times::UntilConverged(Solve::Viscosity) => "until the viscosity has converged:".to_owned(),
    }
}

/// Columns by store, in lines of less than a width.
fn stores(columns: &[Column], width: usize) -> Vec<String> {
    let mut store = None;
    let names = columns.iter().map(|column| {
        let letter = match column.store() {
            Store::Fluid => "F.",
            Store::Nodes => "N.",
            Store::Controls => "C.",
            Store::BodyStore => "B.",
        };
        let (_, name) = column.name().split_once('.').expect("a store and a quantity");
        let prefix = if store == Some(column.store()) { "" } else { letter };
        store = Some(column.store());
        (format!("{prefix}{name}"), format!("{letter}{name}"))
    });
    lines(names, " ", width)
}

/// Words in lines of less than a width, each as it is within a line, and as it is at the beginning of one.
fn lines(words: impl Iterator<Item = (String, String)>, separator: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (within, first) in words {
        match lines.last_mut() {
            Some(last) if last.len() + separator.len() + within.len() < width => {
                last.push_str(separator);
                last.push_str(&within);
            }
            _ => lines.push(first),
        }
    }
    lines
}

/// What a phase needs beyond fluid and sponges, which its columns say.
fn condition(need: &Need) -> Option<String> {
    let name = match need {
        Need::Fluid | Need::Sponge => return None,
        Need::Solver(solver) => format!("{solver:?}"),
        other => format!("{other:?}"),
    };
    let words = name.chars().enumerate().map(|(index, letter)| {
        let space = if index > 0 && letter.is_uppercase() { " " } else { "" };
        format!("{space}{}", letter.to_ascii_lowercase())
    });
    Some(words.collect())
}

/// Both figures, by the marks that they stand between.
fn figures() -> [(&'static str, String); 2] {
    let mut figure = Figure::default();
    figure.begin();
    figure.phases(0, STEP);
    let first = std::mem::take(&mut figure.text);
    figure.begin();
    figure.phases(0, POROUS_STEP);
    [("step", first), ("porous step", figure.text)]
}

/// The page with these figures.
fn with_figures(page: &str, figures: &[(&str, String)]) -> Option<String> {
    let mut page = page.to_owned();
    for (name, text) in figures {
        let (begin, end) =
            (format!("<!-- figure: {name} -->\n"), format!("<!-- end of figure: {name} -->\n"));
        let from = page.find(&begin)? + begin.len();
        let to = from + page[from..].find(&end)?;
        page.replace_range(from..to, &format!("```text\n{text}```\n"));
    }
    Some(page)
}

#[test]
fn the_figures_of_the_architecture_are_the_step() {
    let page = fs::read_to_string(PAGE).expect("ARCHITECTURE.md is there");
    let expected = with_figures(&page, &figures()).expect("both figures have their marks");
    if std::env::var_os("UPDATE_FIGURES").is_some() {
        fs::write(PAGE, &expected).expect("ARCHITECTURE.md can be written");
        return;
    }
    let differs = page.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    assert!(page == expected, "ARCHITECTURE.md: {differs:?}; UPDATE_FIGURES=1 writes it anew");
    // The control: a name that is not that of the kernel.
    let renamed = figures().map(|(name, text)| (name, text.replace("sph::deficit", "sph::surface_slope")));
    assert_ne!(with_figures(&page, &renamed), Some(expected));
}
