//! Error over run time as a picture.

use std::ops::Range;

use plotters::{coord::Shift, prelude::*};

use super::{Point, front, mark_front};

/// Width and height in pixels.
const SIZE: (u32, u32) = (760, 460);
/// Radius of a mark in pixels.
const MARK: i32 = 5;
/// Colours of the solvers, in the order in which they appear: legible on white, also with red-green colour blindness.
const COLOURS: [RGBColor; 3] = [RGBColor(0, 90, 180), RGBColor(213, 94, 0), RGBColor(0, 130, 90)];
const FONT: &str = "sans-serif";

/// Why there is no diagram.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DiagramError {
    /// No run has an error and a time.
    #[error("there is nothing to draw: no run has an error and a time")]
    Nothing,
    /// The writer of SVG failed.
    #[error("cannot draw: {0}")]
    Drawing(String),
}

/// The points of one case as SVG: error over run time, both logarithmic, with a colour and a mark for every solver. Every
/// solver has the line of its own front. Points of the front of all have the numbers of [`front`].
///
/// # Errors
/// [`DiagramError::Nothing`] without a finite point.
pub fn diagram(points: &[Point]) -> Result<String, DiagramError> {
    let finite: Vec<&Point> = points
        .iter()
        .filter(|point| point.error.is_finite() && point.error > 0.0 && point.seconds > 0.0)
        .collect();
    let Some(first) = finite.first() else { return Err(DiagramError::Nothing) };
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    draw(&area, first.case, &finite).map_err(|error| DiagramError::Drawing(error.to_string()))?;
    drop(area);
    Ok(text)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn draw(area: &Area<'_>, case: &str, points: &[&Point]) -> Result<(), Box<dyn std::error::Error>> {
    area.fill(&WHITE)?;
    let seconds = range(points.iter().map(|point| point.seconds));
    let errors = range(points.iter().map(|point| point.error));
    let mut chart = ChartBuilder::on(area)
        .caption(case, (FONT, 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(
            seconds.clone().log_scale().with_key_points(ticks(&seconds)),
            errors.clone().log_scale().with_key_points(ticks(&errors)),
        )?;
    chart
        .configure_mesh()
        .x_desc("run time [s]")
        .y_desc("error")
        .x_label_formatter(&|seconds| number(*seconds))
        .y_label_formatter(&|error| format!("{} %", number(100.0 * error)))
        .label_style((FONT, 13))
        .axis_desc_style((FONT, 14))
        .bold_line_style(RGBColor(220, 220, 220))
        .draw()?;
    let owned: Vec<Point> = points.iter().map(|point| (*point).clone()).collect();
    let front: Vec<(f64, f64)> = front(&owned).iter().map(|point| (point.seconds, point.error)).collect();
    let mut solvers: Vec<&str> = Vec::new();
    for point in points {
        if !solvers.contains(&point.solver) {
            solvers.push(point.solver);
        }
    }
    for (index, solver) in solvers.iter().enumerate() {
        let style = COLOURS[index % COLOURS.len()].filled();
        let mut of: Vec<Point> = owned.iter().filter(|point| point.solver == *solver).cloned().collect();
        let places: Vec<(f64, f64)> = of.iter().map(|point| (point.seconds, point.error)).collect();
        mark_front(&mut of);
        let line: Vec<(f64, f64)> =
            self::front(&of).iter().map(|point| (point.seconds, point.error)).collect();
        chart.draw_series(std::iter::once(PathElement::new(line, style.stroke_width(1))))?;
        let places = places.into_iter();
        // Marks of different shapes are of different types.
        let series = match index % COLOURS.len() {
            0 => chart
                .draw_series(places.map(|place| Circle::new(place, MARK, style)))?
                .legend(move |(x, y)| Circle::new((x + 10, y), MARK, style)),
            1 => chart
                .draw_series(places.map(|place| TriangleMarker::new(place, MARK + 2, style)))?
                .legend(move |(x, y)| TriangleMarker::new((x + 10, y), MARK + 2, style)),
            _ => chart
                .draw_series(places.map(|place| Cross::new(place, MARK, style.stroke_width(2))))?
                .legend(move |(x, y)| Cross::new((x + 10, y), MARK, style.stroke_width(2))),
        };
        series.label(*solver);
    }
    let above = |(label, place): (usize, (f64, f64))| {
        EmptyElement::at(place) + Text::new((label + 1).to_string(), (5, -18), (FONT, 14).into_font())
    };
    chart.draw_series(front.into_iter().enumerate().map(above))?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(205, 205, 205))
        .label_font((FONT, 13))
        .draw()?;
    area.present()?;
    Ok(())
}

/// From half of the smallest value to twice the largest, and at least a decade.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for value in values {
        (low, high) = (low.min(value), high.max(value));
    }
    let middle = (low * high).sqrt();
    (0.6 * low).min(0.32 * middle)..(1.8 * high).max(3.2 * middle)
}

/// 1, 2 and 5 of every decade.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    (-6..7)
        .flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(decade)))
        .filter(|tick| range.contains(tick))
        .collect()
}

/// Without zeros at the end.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
