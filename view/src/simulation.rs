//! The thread that steps the world: it takes requests, and tells facts.

use std::{
    collections::BTreeMap,
    path::Path,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        mpsc::{Receiver, RecvTimeoutError},
    },
    time::{Duration, Instant},
};

use sorb::{Command, Options, Ray, SpongeHandle, StepError, Targets, glam::Vec3, scene::Material};

use crate::{
    Report, Source, ViewError,
    drawing::WorldSender,
    facts::Facts,
    facts_builder::FactsBuilder,
    hand::{self, Hand},
    parameters::{Value, parameters},
    session::Session,
};

/// Real time by which a simulation may lag before it gives up catching up.
const LAG: Duration = Duration::from_millis(100);

/// What the window asks for.
#[derive(Clone, Debug)]
pub enum Request {
    /// Runs, or waits.
    Run(bool),
    /// Takes one frame, and waits.
    Frame,
    /// Takes one step, and waits.
    Step,
    /// Goes back to the first state, with the changes of the sliders.
    Reset,
    /// The same without any changes.
    Restore,
    /// Goes to a frame of a recording.
    Seek(u64),
    /// Goes so many frames on in a recording, or back.
    Skip(i64),
    /// Takes what a ray meets; the answer has this number.
    Take(u64, Ray),
    /// Moves the hand to a place \[m\].
    Reach(Vec3),
    /// Lets go.
    LetGo,
    /// Pours water on what a ray meets, or ends that.
    Pour(Option<Ray>),
    /// Changes a parameter.
    Set(String, Value),
    /// Ends.
    Close,
}

/// What the simulation thread has.
struct Simulation<'a> {
    session: Session<'a>,
    hand: Hand,
    runs: bool,
    /// When the next frame is due.
    due: Instant,
    /// Changes of the scene by their keys, for the next reset.
    changes: BTreeMap<String, Value>,
    /// Commands of sliders for the next step.
    gravity: Option<Vec3>,
    materials: BTreeMap<SpongeHandle, Material>,
    failure: Option<StepError>,
    /// Number of the present state, and of the last one that was given to the thread that draws.
    state: u64,
    given: u64,
    /// Frames after which it is done.
    frames: Option<u64>,
    facts_builder: FactsBuilder,
    facts: &'a Mutex<Facts>,
    worlds: &'a WorldSender,
}

/// How a simulation thread begins.
#[derive(Clone, Copy, Debug)]
pub struct Begin<'a> {
    /// What runs.
    pub source: &'a Source,
    /// On what.
    pub options: &'a Options,
    /// File of a recording.
    pub record: Option<&'a Path>,
    /// Frames after which it waits.
    pub frames: Option<u64>,
    /// Whether it runs at once.
    pub runs: bool,
}

/// Locks facts.
pub fn lock(facts: &Mutex<Facts>) -> MutexGuard<'_, Facts> {
    facts.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs until it is asked to close. `notify` is called whenever there are new facts.
///
/// # Errors
/// The first state cannot be built, or the recording cannot be written.
pub fn run(
    begin: Begin<'_>,
    requests: &Receiver<Request>,
    facts: &Mutex<Facts>,
    worlds: &WorldSender,
    notify: &dyn Fn(),
) -> Result<Report, ViewError> {
    let session = Session::new(begin.source, begin.options, begin.record)?;
    let mut simulation = Simulation {
        session,
        hand: Hand::default(),
        runs: begin.runs,
        due: Instant::now(),
        changes: BTreeMap::new(),
        gravity: None,
        materials: BTreeMap::new(),
        failure: None,
        state: 1,
        given: 0,
        frames: begin.frames,
        facts_builder: FactsBuilder::default(),
        facts,
        worlds,
    };
    simulation.publish_scene();
    if begin.frames == Some(0) {
        simulation.runs = false;
        lock(facts).is_done = true;
        simulation.publish();
    }
    simulation.give(true);
    notify();
    loop {
        let wait =
            if simulation.runs { simulation.due.saturating_duration_since(Instant::now()) } else { LAG };
        let mut next = requests.recv_timeout(wait);
        loop {
            match next {
                Ok(Request::Close) | Err(RecvTimeoutError::Disconnected) => return simulation.finish(),
                Err(RecvTimeoutError::Timeout) => break,
                Ok(request) => {
                    simulation.answer(request);
                    notify();
                }
            }
            next = requests.try_recv().map_err(|_| RecvTimeoutError::Timeout);
        }
        if simulation.runs && Instant::now() >= simulation.due {
            simulation.run_on();
            notify();
        }
    }
}

impl Simulation<'_> {
    /// Takes the frame that is due.
    fn run_on(&mut self) {
        self.frame(false);
        let frame = Duration::from_secs_f32(1.0 / self.session.world().scene().time.frame_rate.max(1.0));
        let now = Instant::now();
        // No step is left out: where frames take longer than they last, simulated time falls behind.
        self.due = (self.due + frame).max(now.checked_sub(LAG).unwrap_or(now));
        self.give(!self.runs);
    }

    /// Takes a frame or a step, with the commands of hand and sliders before it.
    fn frame(&mut self, is_step: bool) {
        if self.session.played().is_none() {
            let acted = self.commands();
            self.note(acted);
        }
        let start = Instant::now();
        let advanced = if is_step { self.session.step() } else { self.session.advance() };
        match advanced {
            Ok(Some(advance)) => {
                self.state += 1;
                let mut facts = lock(self.facts);
                facts.last = Some(advance);
                self.facts_builder.frame(self.session.world(), start.elapsed(), &mut facts);
            }
            Ok(None) => self.runs = false,
            Err(error) => {
                self.runs = false;
                lock(self.facts).failure = Some(error.to_string());
                if let ViewError::Step(error) = error {
                    self.failure = Some(error);
                }
            }
        }
        if self.frames.is_some_and(|frames| self.session.world().clock().frames >= frames)
            || self.failure.is_some()
        {
            self.runs = self.runs && self.frames.is_none();
            lock(self.facts).is_done = self.frames.is_some();
        }
        self.publish();
    }

    fn commands(&mut self) -> Result<(), ViewError> {
        let duration = 1.0 / self.session.world().scene().time.frame_rate;
        if let Some(gravity) = self.gravity.take() {
            self.session.push(Command::Gravity { gravity })?;
        }
        for (sponge, material) in std::mem::take(&mut self.materials) {
            self.session.push(Command::Material { sponge, material })?;
        }
        self.hand.act(&mut self.session, duration)
    }

    fn answer(&mut self, request: Request) {
        // What was refused before is told until something else is asked for.
        if !matches!(request, Request::Reach(_) | Request::LetGo | Request::Pour(None)) {
            lock(self.facts).note = None;
        }
        let result = match request {
            Request::Run(runs) => {
                self.runs = runs && self.failure.is_none();
                self.due = Instant::now();
                self.facts_builder.pause();
                Ok(())
            }
            Request::Frame | Request::Step => {
                self.runs = false;
                if self.failure.is_none() {
                    self.frame(matches!(request, Request::Step));
                }
                Ok(())
            }
            Request::Reset => self.reset(),
            Request::Restore => {
                self.changes.clear();
                self.reset()
            }
            Request::Seek(frame) => self.seek(frame),
            Request::Skip(frames) => {
                let now = self.session.played().map_or(0, |(frame, _)| frame);
                self.seek(now.saturating_add_signed(frames))
            }
            Request::Take(number, ray) => self.take(number, ray),
            Request::Reach(point) => {
                self.hand.reach(self.session.world(), point);
                Ok(())
            }
            Request::LetGo => self.hand.let_go(&mut self.session),
            Request::Pour(ray) => self.pour(ray),
            Request::Set(key, value) => self.set(key, value),
            Request::Close => Ok(()),
        };
        self.note(result);
        self.publish();
        self.give(!self.runs);
    }

    fn seek(&mut self, frame: u64) -> Result<(), ViewError> {
        self.runs = false;
        self.state += 1;
        self.facts_builder.pause();
        lock(self.facts).saturations.clear();
        self.session.seek(frame)
    }

    fn take(&mut self, number: u64, ray: Ray) -> Result<(), ViewError> {
        let hits = self.session.world().cast_rays(&[ray], Targets::ALL);
        let hit = hits.ok().and_then(|hits| hits.first().copied().flatten());
        let mut held = Ok(None);
        if let (Some(hit), None) = (hit, self.session.played()) {
            held = self.hand.take(&mut self.session, &hit).map(|name| name.map(|name| (hit.point, name)));
        }
        let (held, result) = held.map_or_else(|error| (None, Err(error)), |held| (held, Ok(())));
        lock(self.facts).held = Some((number, held));
        result
    }

    fn pour(&mut self, ray: Option<Ray>) -> Result<(), ViewError> {
        let Some(ray) = ray else {
            self.hand.pour(None);
            return Ok(());
        };
        if self.session.played().is_some() {
            return Err(ViewError::Plays);
        }
        if self.session.world().scene().fluid.is_none() {
            return Err(ViewError::NoWater);
        }
        if let Ok(Some(spout)) = hand::spout(self.session.world(), ray) {
            self.hand.pour(Some(spout));
        }
        Ok(())
    }

    fn set(&mut self, key: String, value: Value) -> Result<(), ViewError> {
        let mut facts = lock(self.facts);
        let Some(own) = facts.parameters.iter_mut().find(|own| own.key == key) else { return Ok(()) };
        let (at_once, sponge, field, before) = (own.acts_at_once(), own.sponge, own.field, own.value);
        own.value = value;
        drop(facts);
        let known = self.changes.insert(key.clone(), value);
        if let Source::Scene(scene) = self.session.source()
            && let Err(error) = scene.with_overrides(self.texts().iter().map(String::as_str))
        {
            match known {
                Some(known) => self.changes.insert(key.clone(), known),
                None => self.changes.remove(&key),
            };
            lock(self.facts)
                .parameters
                .iter_mut()
                .filter(|own| own.key == key)
                .for_each(|own| own.value = before);
            return Err(error.into());
        }
        match (sponge, value) {
            (Some(sponge), _) => {
                let present =
                    self.materials.get(&sponge).copied().or_else(|| self.session.world().material(sponge));
                let changed = present.and_then(|present| value.in_material(&present, field));
                self.materials.extend(changed.map(|material| (sponge, material)));
            }
            (None, Value::Vector(gravity)) if at_once => self.gravity = Some(gravity.into()),
            _ => lock(self.facts).waits = true,
        }
        Ok(())
    }

    fn texts(&self) -> Vec<String> {
        self.changes.iter().map(|(key, value)| format!("{key}={}", value.text())).collect()
    }

    fn reset(&mut self) -> Result<(), ViewError> {
        let changes = if self.session.has_scene() { self.texts() } else { Vec::new() };
        self.session.reset(&changes)?;
        self.hand = Hand::default();
        self.failure = None;
        self.gravity = None;
        self.materials.clear();
        self.state += 1;
        self.due = Instant::now();
        self.facts_builder = FactsBuilder::default();
        self.publish_scene();
        Ok(())
    }

    /// Tells what does not change from frame to frame.
    fn publish_scene(&mut self) {
        let world = self.session.world();
        let mut facts = lock(self.facts);
        let epoch = facts.epoch + 1;
        *facts = Facts { epoch, held: facts.held.take(), ..Facts::default() };
        self.facts_builder.scene(world, &mut facts);
        if self.session.played().is_none() {
            facts.parameters = parameters(world);
            if !self.session.has_scene() {
                facts.parameters.retain(crate::parameters::Parameter::acts_at_once);
            }
        }
        drop(facts);
        self.publish();
    }

    fn publish(&mut self) {
        let mut facts = lock(self.facts);
        facts.runs = self.runs;
        facts.played = self.session.played();
        self.facts_builder.clock(self.session.world(), &mut facts);
    }

    fn note(&mut self, result: Result<(), ViewError>) {
        if let Err(error) = result {
            lock(self.facts).note = Some(error.to_string());
        }
    }

    /// Gives a copy of the world to the thread that draws: whenever it has taken the last one, or at once.
    fn give(&mut self, at_once: bool) {
        if self.given != self.state && (at_once || self.worlds.is_empty()) {
            self.worlds.put(self.state, Arc::new(self.session.world().clone()));
            self.given = self.state;
        }
    }

    fn finish(self) -> Result<Report, ViewError> {
        let world = self.session.world();
        let report = Report {
            name: world.scene().name.clone(),
            frames: world.clock().frames,
            time: world.clock().time,
            digest: world.digest(),
            commands: self.session.commands().clone(),
            pictures: 0,
            failure: self.failure,
        };
        self.session.finish()?;
        Ok(report)
    }
}
