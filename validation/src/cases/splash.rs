//! How fast the fastest particle of a breaking dam gets.

use sorb::scene::preset;

use crate::case::{Case, Failure, Figure, Setting, Subject};

/// The scene `water`, fine.
pub(super) static CASE: Case = Case {
    name: "splash",
    title: "fastest particle of the scene `water` until its front is half way to the other wall, at two resolutions",
    source: "no more than 1.3 sqrt(2 g H): what falls from the surface, and a third more",
    subject: Subject::Water,
    control: "gravity three times as strong",
    run,
};

/// Height of the dam \[m\].
const HEIGHT: f64 = 0.105;
/// Factors on the resolution of the scene.
const RESOLUTIONS: [f64; 2] = [1.0, 2.0];
/// Speed that is in bounds over that of a free fall.
const BOUND: f64 = 1.3;
/// Time that is watched \[s\].
const TIME: f64 = 0.2;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let fall = (2.0 * GRAVITY * HEIGHT).sqrt();
    let mut figures = Vec::new();
    for resolution in setting.pick(&RESOLUTIONS[..], &RESOLUTIONS[..1]) {
        let mut scene = preset("water")?.scaled((resolution * setting.resolution) as f32)?;
        scene.gravity *= setting.planted(1.0, 3.0) as f32;
        let mut world = setting.world(&scene)?;
        let mut fastest = 0.0_f64;
        while world.clock().time < TIME {
            fastest = fastest.max(f64::from(setting.advance(&mut world)?.maximum_speed));
        }
        figures.push(Figure {
            name: format!("fastest particle at resolution {resolution}, over sqrt(2 g H)"),
            unit: "1",
            reference: 1.0,
            measured: fastest / fall,
            error: fastest / fall,
            bound: BOUND,
        });
    }
    Ok(figures)
}
