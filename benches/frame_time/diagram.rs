//! Times of frames as a picture.

use plotters::prelude::*;

use super::{
    Result, name_of,
    sweep::{Backend, Row, Sweep},
};

/// Width and height in pixels.
const SIZE: (u32, u32) = (760, 460);
/// Colours of the views: legible on white, also with red-green colour blindness.
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 90, 180), RGBColor(213, 94, 0), RGBColor(0, 130, 90), RGBColor(120, 60, 140)];
const FONT: &str = "sans-serif";
/// What the paper states for 8192 particles and 1024 nodes on a GTX 1080 Ti, with realistic rendering (ms).
const OF_PAPER: (f64, f64, f64) = (8192.0, 1024.0, 30.0);

/// Simulation and drawing of a frame over the number that a sweep varies, both logarithmic. Full marks are those of a GPU.
pub(super) fn diagram(sweep: Sweep, rows: &[Row]) -> Result<String> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.sweep == sweep && row.drawing.is_finite()).collect();
    let place = |row: &Row| if sweep == Sweep::Particles { row.particles as f64 } else { row.nodes as f64 };
    let paper = if sweep == Sweep::Particles { OF_PAPER.0 } else { OF_PAPER.1 };
    let total = |row: &Row| row.drawing + if row.simulation.is_finite() { row.simulation } else { 0.0 };
    let places = range(rows.iter().map(|row| place(row)).chain([paper]));
    let times = range(rows.iter().map(|row| total(row)).chain([OF_PAPER.2]));
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d((places.0..places.1).log_scale(), (times.0..times.1).log_scale())?;
    let mesh = &mut chart.configure_mesh();
    mesh.x_desc(sweep.name())
        .y_desc("simulation and drawing of a frame [ms]")
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_label_formatter(&|value| format!("{value:.0}"))
        .light_line_style(TRANSPARENT)
        .label_style((FONT, 13))
        .draw()?;
    let mut views: Vec<_> = rows.iter().map(|row| row.view).collect();
    views.dedup();
    views.sort_by_key(|view| name_of(*view));
    views.dedup();
    for (view, colour) in views.iter().zip(COLOURS.iter().cycle()) {
        for backend in Backend::ALL {
            let own = rows.iter().filter(|row| row.view == *view && row.backend == backend);
            let points: Vec<(f64, f64)> = own.map(|row| (place(row), total(row))).collect();
            let style = if backend == Backend::Gpu { colour.filled() } else { colour.stroke_width(1) };
            let name = format!("{} on the {}", name_of(*view), backend.name().to_uppercase());
            chart
                .draw_series(LineSeries::new(points.clone(), colour.stroke_width(1)))?
                .label(name)
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, style));
            chart.draw_series(points.into_iter().map(|point| Circle::new(point, 4, style)))?;
        }
    }
    chart
        .draw_series([TriangleMarker::new((paper, OF_PAPER.2), 7, BLACK.filled())])?
        .label("the paper, GTX 1080 Ti")
        .legend(|(x, y)| TriangleMarker::new((x + 9, y), 6, BLACK.filled()));
    let labels = &mut chart.configure_series_labels();
    labels
        .position(match sweep {
            Sweep::Particles => SeriesLabelPosition::UpperLeft,
            Sweep::Nodes => SeriesLabelPosition::MiddleRight,
        })
        .background_style(WHITE.mix(0.8))
        .label_font((FONT, 13))
        .draw()?;
    drop(chart);
    drop(area);
    Ok(text)
}

/// Least and largest value, with room around them.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (least, most) = values.fold((f64::MAX, f64::MIN), |(a, b), value| (a.min(value), b.max(value)));
    (0.7 * least.max(1e-3), 1.4 * most.max(1e-2))
}
