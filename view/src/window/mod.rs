//! The window: it shows pictures and panels, and turns mouse and keys into requests.

mod app;
mod panels;
mod pointer;
mod rasteriser;
mod sliders;
mod surface;

use std::{
    sync::{
        Arc, Mutex,
        mpsc::{self, Sender},
    },
    thread,
};

use winit::event_loop::EventLoop;

use crate::{
    Report, Setup, ViewError,
    drawing::{CpuRenderer, DrawingThread, WorldRenderer},
    facts::Facts,
    simulation::{self, Begin, Request},
};
use app::App;

/// What wakes the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wake {
    /// There is a picture.
    Picture,
    /// There are facts.
    Facts,
    /// The simulation thread has ended.
    End,
}

/// Shows a window until it is closed.
///
/// # Errors
/// There is no display, the system refuses the window, the world cannot be built, or a file cannot be written.
pub fn run(setup: &Setup) -> Result<Report, ViewError> {
    let event_loop = EventLoop::<Wake>::with_user_event()
        .build()
        .map_err(|error| ViewError::NoDisplay(reason(&error.to_string())))?;
    let facts = Arc::new(Mutex::new(Facts::default()));
    let (requests, taken) = mpsc::channel();
    let proxies = [event_loop.create_proxy(), event_loop.create_proxy(), event_loop.create_proxy()];
    let [pictures, facts_ready, ended] = proxies;
    // The window may be gone before the others know.
    let drawing = DrawingThread::new(renderer(setup), move || {
        let _ = pictures.send_event(Wake::Picture);
    });
    let worlds = drawing.worlds();
    thread::scope(|scope| {
        let own = Arc::clone(&facts);
        let begin = Begin {
            source: &setup.source,
            options: &setup.options,
            record: setup.record.as_deref(),
            frames: setup.frames,
            runs: !setup.paused,
        };
        let simulation = scope.spawn(move || {
            let tell = || {
                let _ = facts_ready.send_event(Wake::Facts);
            };
            let report = simulation::run(begin, &taken, &own, &worlds, &tell);
            let _ = ended.send_event(Wake::End);
            report
        });
        let mut app = App::new(setup, facts, requests, drawing);
        let shown = event_loop.run_app(&mut app);
        app.close();
        let report = match simulation.join() {
            Ok(report) => report?,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        shown.map_err(|error| ViewError::Window(error.to_string()))?;
        app.end(report)
    })
}

/// What draws: a GPU, or the CPU.
fn renderer(setup: &Setup) -> Box<dyn WorldRenderer> {
    #[cfg(feature = "gpu")]
    if !setup.software
        && let Some(device) = crate::gpu_renderer::GpuRenderer::best(setup.options.gpu.as_ref())
    {
        return Box::new(device);
    }
    let _ = setup;
    Box::new(CpuRenderer)
}

/// Sends a request. The simulation thread ends last, so that nothing is lost.
fn send(requests: &Sender<Request>, request: Request) {
    let _ = requests.send(request);
}

/// An error of the system without the place in the source that begins it.
fn reason(text: &str) -> String {
    let end = text.split_once(".rs:").and_then(|(_, end)| end.split_once(": "));
    end.map_or(text, |(_, reason)| reason).to_owned()
}
