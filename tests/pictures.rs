//! Pictures of every view against small ones that a person has looked at (`snapshots/pictures`). `UPDATE_PICTURES=1` writes them anew.

use std::{path::PathBuf, sync::OnceLock};

use sorb::{
    Options, SimdLevel, World,
    glam::Vec3,
    render::{Camera, Image, Steady, View, draw_world},
    scene,
};

const SIZE: (u32, u32) = (192, 108);
/// Levels of 255 that a pixel may differ by, and the share of pixels that may differ more.
const LEVELS: u8 = 12;
const SHARE: f64 = 0.005;

/// A ball presses a sponge under water, after so many frames.
fn world(frames: u32, options: &Options) -> World {
    let scene = scene::preset("life").and_then(|scene| scene.scaled(0.5));
    let scene = scene.and_then(|scene| {
        scene.with_overrides([
            "bodies.ball.position=[0, 0.12, 0]",
            "sponges.sponge.position=[-0.04, 0.04, -0.04]",
        ])
    });
    let mut world = World::with_options(&scene.expect("a scene"), options).expect("a world");
    for _ in 0..frames {
        world.advance_frame().expect("a frame");
    }
    world
}

/// The world of most tests.
fn pressed() -> &'static World {
    static WORLD: OnceLock<World> = OnceLock::new();
    WORLD.get_or_init(|| world(12, &Options::default()))
}

/// Of its own, so that scenes may have others.
fn camera(world: &World) -> Camera {
    let own = Camera::from(world.scene().viewpoint());
    Camera { eye: Vec3::new(0.2, 0.26, 0.32), target: Vec3::new(0.0, 0.06, 0.0), ..own }
}

fn picture(world: &World, view: View) -> Image {
    draw_world(world, &camera(world), view, SIZE.0, SIZE.1)
}

/// Share of the pixels that differ by more than [`LEVELS`].
fn difference(a: &Image, b: &Image) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > LEVELS);
    let pixels = a.pixels.chunks(3).zip(b.pixels.chunks(3));
    pixels.clone().filter(differs).count() as f64 / pixels.count() as f64
}

fn golden(view: View) -> PathBuf {
    let name = format!("{view:?}.png").to_lowercase();
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("snapshots/pictures").join(name)
}

fn read(path: &PathBuf) -> Image {
    let file = std::fs::File::open(path).expect("the golden picture is there");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG file");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size that fits")];
    let info = reader.next_frame(&mut pixels).expect("a whole picture");
    Image { width: info.width, height: info.height, pixels }
}

#[test]
fn every_view_shows_what_was_looked_at() {
    let world = pressed();
    let mut others: Vec<Image> = Vec::new();
    for view in View::ALL {
        let (path, drawn) = (golden(view), picture(world, view));
        if std::env::var_os("UPDATE_PICTURES").is_some() {
            drawn.write_png(&path).expect("the golden picture can be written");
        }
        let expected = read(&path);
        let found = difference(&drawn, &expected);
        assert!(found <= SHARE, "{view:?}: {found:.4} of the pixels differ from {}", path.display());
        // Negative controls: another camera, other views.
        let mut moved = camera(world);
        moved.eye.x += 0.03;
        let moved = draw_world(world, &moved, view, SIZE.0, SIZE.1);
        assert!(difference(&moved, &expected) > 2.0 * SHARE, "{view:?}: another camera");
        for other in &others {
            assert!(difference(other, &expected) > 4.0 * SHARE, "{view:?}: another view");
        }
        others.push(expected);
    }
}

#[test]
fn another_state_is_another_picture() {
    let before = world(2, &Options::default());
    for view in View::ALL {
        assert!(difference(&picture(&before, view), &read(&golden(view))) > 2.0 * SHARE, "{view:?}");
    }
}

#[test]
fn threads_and_instruction_sets_do_not_matter() {
    let slow = Options { threads: Some(1), simd: Some(SimdLevel::Fallback), ..Options::default() };
    let slow = world(12, &slow);
    for view in View::ALL {
        let expected = picture(pressed(), view);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let drawn = pool.install(|| picture(&slow, view));
            assert!(drawn == expected, "{view:?} on {threads} threads");
        }
    }
    // Negative control: bits of the state show.
    assert!(picture(&world(11, &Options::default()), View::Realistic) != picture(pressed(), View::Realistic));
}

#[test]
fn a_picture_does_not_depend_on_the_one_before() {
    let first = picture(pressed(), View::Realistic);
    let other = world(2, &Options::default());
    assert!(picture(&other, View::Realistic) != first);
    assert!(picture(pressed(), View::Realistic) == first);
}

#[test]
fn steady_pictures_start_with_the_state_and_follow_it() {
    let mut steady = Steady::default();
    let (width, height) = SIZE;
    let mut draw = |world: &World| steady.draw_world(world, &camera(world), View::Realistic, width, height);
    assert!(draw(pressed()) == picture(pressed(), View::Realistic));
    let moved = world(20, &Options::default());
    let followed = draw(&moved);
    assert!(difference(&followed, &picture(&moved, View::Realistic)) < 0.02);
    // Negative control: it is not the picture before.
    assert!(difference(&followed, &picture(pressed(), View::Realistic)) > 0.03);
}

#[test]
fn scenes_without_water_or_sponge_and_odd_sizes_are_drawn() {
    for name in ["empty", "dry", "water"] {
        let scene = scene::preset(name).and_then(|scene| scene.scaled(0.4)).expect("a scene");
        let world = World::new(&scene).expect("a world");
        for view in View::ALL {
            for (width, height) in [(0, 9), (1, 1), (33, 17)] {
                let image = draw_world(&world, &camera(&world), view, width, height);
                assert_eq!(image.pixels.len(), (width * height * 3) as usize, "{name} {view:?}");
            }
        }
    }
}

/// Water that fills the whole picture, in pictures that are narrower than the reach of its filter.
#[test]
fn water_is_drawn_up_to_the_edges_of_narrow_pictures() {
    let scene = scene::preset("life").and_then(|scene| scene.scaled(0.5)).expect("a scene");
    let world = World::new(&scene).expect("a world");
    let camera = Camera {
        eye: Vec3::new(0.05, 0.12, 0.01),
        target: Vec3::new(0.05, 0.05, 0.0),
        up: Vec3::Y,
        field_of_view: 0.7,
    };
    for (width, height) in [(9, 40), (64, 64)] {
        let image = draw_world(&world, &camera, View::Fast, width, height);
        // Bluer than red in the corners as well: there is water, and no sky.
        let corners = [0, width - 1, width * (height - 1), width * height - 1];
        for corner in corners {
            let at = 3 * corner as usize;
            assert!(
                image.pixels[at + 2] > image.pixels[at],
                "{width} x {height}: {:?}",
                &image.pixels[at..at + 3]
            );
        }
    }
}
