//! The thread that draws: copies of the world, as a camera sees them.

use std::{
    panic::{self, AssertUnwindSafe},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use sorb::{
    World,
    render::{self, Camera, Image, View},
};

use crate::quality::{Quality, QualityControl};

/// How long nothing has changed when a picture of full quality is drawn.
const STILL: Duration = Duration::from_millis(180);

/// Draws pictures of a world. This is the place of other renderers: give one to [`DrawingThread::new`].
pub trait WorldRenderer: Send {
    /// Draws a world as a camera sees it.
    fn draw(&mut self, world: &World, camera: &Camera, view: View, size: (u32, u32)) -> Image;

    /// What it is, for the panel.
    fn name(&self) -> String;
}

/// Draws with the CPU.
#[derive(Clone, Copy, Debug, Default)]
pub struct CpuRenderer;

impl WorldRenderer for CpuRenderer {
    fn draw(&mut self, world: &World, camera: &Camera, view: View, (width, height): (u32, u32)) -> Image {
        render::draw_world(world, camera, view, width, height)
    }

    fn name(&self) -> String {
        "the CPU".to_owned()
    }
}

/// What a picture is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureRequest {
    /// Point of view.
    pub camera: Camera,
    /// What is shown.
    pub view: View,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Whether pictures are drawn in full quality, whatever that takes.
    pub full: bool,
    /// Whether the world runs, so that no picture is the last one of a state.
    pub runs: bool,
}

/// A picture, and how it was drawn.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The picture: its sides are those of the request or smaller.
    pub image: Image,
    /// How it was drawn.
    pub quality: Quality,
    /// Name of the renderer.
    pub renderer: String,
    /// What it took.
    pub time: Duration,
    /// Frames of the world that it shows.
    pub frames: u64,
    /// Whether it is the best picture of a state and a camera: nothing has changed since.
    pub is_still: bool,
}

/// What the threads share.
#[derive(Debug, Default)]
struct Shared {
    /// A state to draw, and its number.
    world: Option<(u64, Arc<World>)>,
    request: Option<PictureRequest>,
    picture: Option<Picture>,
    closes: bool,
}

/// The thread that draws.
#[derive(Debug)]
pub struct DrawingThread {
    shared: Arc<(Mutex<Shared>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

/// Gives worlds to the thread that draws.
#[derive(Clone, Debug)]
pub struct WorldSender(Arc<(Mutex<Shared>, Condvar)>);

impl DrawingThread {
    /// Begins. `drawn` is called after every picture.
    #[must_use]
    pub fn new(mut renderer: Box<dyn WorldRenderer>, drawn: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::<(Mutex<Shared>, Condvar)>::default();
        let own = Arc::clone(&shared);
        let thread = thread::spawn(move || {
            let result = panic::catch_unwind(AssertUnwindSafe(|| work(&own, &mut *renderer, &drawn)));
            // Whoever waits for a picture learns that there is none.
            if let Err(panic) = result {
                lock(&own.0).closes = true;
                drawn();
                panic::resume_unwind(panic);
            }
        });
        Self { shared, thread: Some(thread) }
    }

    /// What gives worlds to it.
    #[must_use]
    pub fn worlds(&self) -> WorldSender {
        WorldSender(Arc::clone(&self.shared))
    }

    /// Asks for pictures of another kind.
    pub fn show(&self, request: PictureRequest) {
        let mut shared = lock(&self.shared.0);
        if shared.request != Some(request) {
            shared.request = Some(request);
            self.shared.1.notify_all();
        }
    }

    /// Panics as the thread that draws did, if it did.
    pub fn check(&mut self) {
        if lock(&self.shared.0).closes
            && let Some(Err(panic)) = self.thread.take().map(JoinHandle::join)
        {
            panic::resume_unwind(panic);
        }
    }

    /// The picture since the last call; none if there is none.
    #[must_use]
    pub fn picture(&self) -> Option<Picture> {
        lock(&self.shared.0).picture.take()
    }
}

impl Drop for DrawingThread {
    fn drop(&mut self) {
        lock(&self.shared.0).closes = true;
        self.shared.1.notify_all();
        if let Some(thread) = self.thread.take() {
            // A panic has been printed.
            let _ = thread.join();
        }
    }
}

impl WorldSender {
    /// Whether the last world has been taken, so that another one is not made in vain.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        lock(&self.0.0).world.is_none()
    }

    /// Gives a world with its number.
    pub fn put(&self, number: u64, world: Arc<World>) {
        lock(&self.0.0).world = Some((number, world));
        self.0.1.notify_all();
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What there is to draw.
enum Due {
    Moving,
    Still,
    Nothing,
}

fn work(shared: &(Mutex<Shared>, Condvar), renderer: &mut dyn WorldRenderer, drawn: &dyn Fn()) {
    let mut control = QualityControl::default();
    let mut world: Option<(u64, Arc<World>)> = None;
    let (mut last, mut is_best, mut changed) = (None, true, Instant::now());
    loop {
        let mut guard = lock(&shared.0);
        let due = loop {
            if guard.closes {
                return;
            }
            if let Some(next) = guard.world.take() {
                world = Some(next);
            }
            let now = world.as_ref().map(|(number, _)| *number).zip(guard.request);
            let rest = STILL.saturating_sub(changed.elapsed());
            let due = match now {
                Some(_) if now != last => Due::Moving,
                Some((_, request)) if !is_best && !request.runs && rest.is_zero() => Due::Still,
                _ => Due::Nothing,
            };
            if !matches!(due, Due::Nothing) {
                break due;
            }
            let wait = if is_best { Duration::from_secs(3600) } else { rest.max(Duration::from_millis(1)) };
            let woken = shared.1.wait_timeout(guard, wait);
            guard = woken.unwrap_or_else(PoisonError::into_inner).0;
        };
        let request = guard.request;
        drop(guard);
        let (Some((number, world)), Some(request)) = (&world, request) else { continue };
        let is_still = matches!(due, Due::Still);
        if !is_still {
            (last, changed) = (Some((*number, request)), Instant::now());
        }
        let picture = draw(
            renderer,
            world,
            &request,
            control.quality(request.view, is_still || request.full),
            is_still,
        );
        if !is_still && !request.full {
            control.took(picture.time);
        }
        is_best = picture.quality == (Quality { view: request.view, scale: 1.0 });
        let picture = Picture { is_still: is_best && !request.runs, ..picture };
        lock(&shared.0).picture = Some(picture);
        drawn();
    }
}

fn draw(
    renderer: &mut dyn WorldRenderer,
    world: &World,
    request: &PictureRequest,
    quality: Quality,
    is_still: bool,
) -> Picture {
    let start = Instant::now();
    let side = |side: u32| ((side as f32 * quality.scale).round() as u32).max(1);
    let size = (side(request.size.0), side(request.size.1));
    let image = renderer.draw(world, &request.camera, quality.view, size);
    let (renderer, time) = (renderer.name(), start.elapsed());
    Picture { image, quality, renderer, time, frames: world.clock().frames, is_still }
}
