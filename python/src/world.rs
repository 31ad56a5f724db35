//! A world: steps, commands, questions, columns, states and pictures.

use pyo3::{prelude::*, types::PyBytes};
use sorb::{
    Command, Ledger, Load, Recorder, Save, Surface, Targets,
    glam::Vec3,
    render::{self, View},
};

use crate::{
    error::{OrRaise, exception},
    loan::{Loan, Loans, Rows},
    scene::{options, scene_of},
    state::Snapshot,
};

/// Name, position, rotation, velocity and angular velocity of a body.
type Body<'a> = (&'a str, [f32; 3], [f32; 4], [f32; 3], [f32; 3]);

/// Name, force and torque of what acts on a body.
type Source = (&'static str, [f64; 3], [f64; 3]);

/// A scene in motion, without arrays.
#[pyclass(module = "sorb._sorb")]
#[derive(Debug)]
pub(crate) struct World {
    world: sorb::World,
    recorder: Option<Recorder>,
    loans: Loans,
    /// Counts changes of the state.
    #[pyo3(get)]
    generation: u64,
}

impl World {
    fn of(world: sorb::World) -> Self {
        Self { world, recorder: None, loans: Loans::default(), generation: 0 }
    }

    /// Before anything that changes columns.
    fn begin_change(&mut self) -> PyResult<()> {
        self.loans.check()?;
        self.generation += 1;
        Ok(())
    }

    fn begin_jump(&mut self) -> PyResult<()> {
        if self.recorder.is_some() {
            let message =
                "the world is being recorded, and a recording holds no jumps: end the recording first";
            return Err(exception("StateError", message, Vec::new()));
        }
        self.begin_change()
    }
}

#[pymethods]
impl World {
    /// Builds a world; the arguments are those of `read_scene`, and what it runs on.
    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "called by one function of the package")]
    fn build(
        py: Python<'_>,
        kind: &str,
        text: &str,
        quality: Option<&str>,
        overrides: Vec<String>,
        resolution: f32,
        threads: Option<usize>,
        simd: Option<&str>,
        backend: &str,
    ) -> PyResult<Self> {
        let options = options(threads, simd, backend)?;
        let scene = scene_of((kind, text), quality, &overrides, resolution)?;
        py.detach(|| sorb::World::with_options(&scene, &options)).map(Self::of).or_raise()
    }

    #[staticmethod]
    fn restore(
        py: Python<'_>,
        save: &[u8],
        threads: Option<usize>,
        simd: Option<&str>,
        backend: &str,
    ) -> PyResult<Self> {
        let options = options(threads, simd, backend)?;
        py.detach(|| sorb::World::restore(save, &options)).map(Self::of).or_raise()
    }

    fn copy(&self, py: Python<'_>) -> Self {
        Self::of(py.detach(|| self.world.clone()))
    }

    fn step(&mut self, py: Python<'_>) -> PyResult<(f64, f32, &'static str, f32)> {
        self.begin_change()?;
        let Self { world, recorder, .. } = self;
        let report = py.detach(|| match recorder {
            Some(recorder) => recorder.step(world),
            None => world.step(),
        });
        report.map(|own| (own.time, own.step, own.bound.name(), own.maximum_speed)).or_raise()
    }

    fn advance_frame(&mut self, py: Python<'_>) -> PyResult<(f64, u32, f32, &'static str, f32)> {
        self.begin_change()?;
        let Self { world, recorder, .. } = self;
        let report = py.detach(|| match recorder {
            Some(recorder) => recorder.advance_frame(world),
            None => world.advance_frame(),
        });
        let report = report.or_raise()?;
        Ok((report.time, report.steps, report.shortest_step, report.bound.name(), report.maximum_speed))
    }

    fn push(&mut self, json: &str) -> PyResult<()> {
        let command: Command = serde_json::from_str(json)
            .map_err(|error| exception("CommandError", &format!("command: {error}"), Vec::new()))?;
        let Self { world, recorder, .. } = self;
        match recorder {
            Some(recorder) => recorder.push(world, command),
            None => world.push(command),
        }
        .or_raise()
    }

    fn clock(&self) -> (f64, u64, u64) {
        let clock = self.world.clock();
        (clock.time, clock.steps, clock.frames)
    }

    fn digest(&self, py: Python<'_>) -> PyResult<u64> {
        py.detach(|| self.world.try_digest()).or_raise()
    }

    fn scene(&self) -> PyResult<String> {
        self.world.scene().to_json().or_raise()
    }

    fn next_flow(&self) -> u32 {
        self.world.next_flow().number()
    }

    /// Handle of the next body: its number, and how many had it before.
    fn next_body(&self) -> (usize, u32) {
        let body = self.world.next_body();
        (body.index(), body.generation())
    }

    /// Handle of the next sponge.
    fn next_sponge(&self) -> (usize, u32) {
        let sponge = self.world.next_sponge();
        (sponge.index(), sponge.generation())
    }

    /// Handles of the bodies that are there.
    fn body_handles(&self) -> Vec<(usize, u32)> {
        self.world.body_handles().map(|body| (body.index(), body.generation())).collect()
    }

    fn bodies(&self) -> Vec<Body<'_>> {
        let bodies = self.world.bodies().iter().zip(&self.world.scene().bodies);
        bodies
            .map(|(body, own)| {
                let state = &body.state;
                let (position, rotation) = (state.position.to_array(), state.rotation.to_array());
                let (linear, angular) = (state.linear_velocity.to_array(), state.angular_velocity.to_array());
                (own.name.as_str(), position, rotation, linear, angular)
            })
            .collect()
    }

    fn body_loads(&self) -> Vec<[Source; 4]> {
        let load = |name: &'static str, load: Load| (name, load.force.to_array(), load.torque.to_array());
        let loads = self.world.body_loads().into_iter();
        loads
            .map(|own| {
                [
                    load("fluid", own.fluid),
                    load("sponges", own.sponges),
                    load("host", own.host),
                    load("contact", own.contact),
                ]
            })
            .collect()
    }

    fn measures(&self, py: Python<'_>) -> Vec<(&'static str, Vec<f64>)> {
        py.detach(|| self.world.measures()).named().into()
    }

    fn ledger(&self) -> (Vec<(&'static str, i64)>, f32) {
        let own: Ledger = self.world.ledger();
        let counts = [
            ("seeded", own.seeded),
            ("poured", own.poured),
            ("removed", own.removed),
            ("drained", own.drained),
            ("present", own.present),
            ("absorbed", own.absorbed),
            ("left_out", own.left_out),
        ];
        let mut counts: Vec<(&'static str, i64)> = counts
            .into_iter()
            .map(|(name, count)| (name, i64::try_from(count).unwrap_or(i64::MAX)))
            .collect();
        counts.push(("lost", own.lost));
        (counts, own.particle_mass)
    }

    /// Lends a column that is stored.
    fn lend(slf: Bound<'_, Self>, column: &str) -> PyResult<Loan> {
        let own = slf.try_borrow()?;
        let world = &own.world;
        let rows = match column {
            "particle_positions" => Rows::vectors(world.particle_positions()),
            "particle_velocities" => Rows::vectors(world.particle_velocities()),
            "particle_ids" => Rows::integers(world.particle_ids()),
            "node_positions" => Rows::vectors(world.node_positions()),
            "node_velocities" => Rows::vectors(world.node_velocities()),
            "node_saturations" => Rows::floats(world.node_saturations()),
            "node_sponges" => Rows::integers(&world.lattice().node_sponge),
            "triangles" => Rows::triples(&world.lattice().triangles),
            other => return Err(no_column(other)),
        };
        Ok(Loan::new(rows, &own.loans, slf.clone().unbind()))
    }

    /// Computes a column, as floats of 32 bits.
    fn compute<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyBytes>> {
        let values = py.detach(|| match column {
            "particle_pressures" => Ok(self.world.particle_pressures()),
            "particle_densities" => Ok(self.world.particle_densities()),
            "node_masses" => Ok(self.world.node_masses()),
            other => Err(no_column(other)),
        })?;
        Ok(floats_to_bytes(py, values))
    }

    /// Rays as rows of seven floats; hits as rows of nine: distance, point, normal, surface, number.
    fn cast_rays<'py>(
        &self,
        py: Python<'py>,
        rays: &[u8],
        targets: [bool; 3],
    ) -> PyResult<Bound<'py, PyBytes>> {
        let ray = |row: [f32; 7]| {
            let [x, y, z, u, v, w, length] = row;
            sorb::Ray { origin: Vec3::new(x, y, z), direction: Vec3::new(u, v, w), length }
        };
        let rays: Vec<sorb::Ray> = rows_of(rays).map(ray).collect();
        let [bodies, sponges, water] = targets;
        let hits =
            py.detach(|| self.world.cast_rays(&rays, Targets { bodies, sponges, water })).or_raise()?;
        let row = |hit: Option<sorb::Hit>| {
            let Some(hit) = hit else { return [f32::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
            let (surface, number) = match hit.surface {
                Surface::Body(number) => (1.0, number),
                Surface::Sponge(number) => (2.0, number),
                Surface::Water => (3.0, 0),
                _ => (0.0, 0),
            };
            let (point, normal) = (hit.point, hit.normal);
            [hit.distance, point.x, point.y, point.z, normal.x, normal.y, normal.z, surface, number as f32]
        };
        Ok(floats_to_bytes(py, hits.into_iter().flat_map(row)))
    }

    /// Places as rows of two floats; levels, NaN where there is no water.
    fn water_levels<'py>(&self, py: Python<'py>, places: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let places: Vec<[f32; 2]> = rows_of(places).collect();
        let levels = py.detach(|| self.world.water_levels(&places)).or_raise()?;
        Ok(floats_to_bytes(py, levels.into_iter().map(|level| level.unwrap_or(f32::NAN))))
    }

    /// Points as rows of three floats; probes as rows of thirteen.
    fn probe<'py>(&self, py: Python<'py>, points: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let points: Vec<Vec3> = rows_of(points).map(Vec3::from_array).collect();
        let probes = py.detach(|| self.world.probe(&points)).or_raise()?;
        let row = |probe: sorb::Probe| {
            let Vec3 { x, y, z } = probe.velocity;
            let mut row = vec![
                probe.filled,
                probe.density,
                x,
                y,
                z,
                probe.pressure,
                -1.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ];
            if let Some(sponge) = probe.sponge {
                let Vec3 { x, y, z } = sponge.velocity;
                let own = [sponge.sponge as f32, sponge.saturation, sponge.pore_pressure, x, y, z];
                row.truncate(6);
                row.extend(own);
                row.push(sponge.volume_ratio);
            }
            row
        };
        Ok(floats_to_bytes(py, probes.into_iter().flat_map(row)))
    }

    fn save<'py>(&self, py: Python<'py>, compressed: bool) -> PyResult<Bound<'py, PyBytes>> {
        let write = || {
            let mut bytes = Vec::new();
            let save = self.world.to_save()?;
            if compressed {
                save.write_compressed(&mut bytes)?
            } else {
                save.write(&mut bytes)?
            }
            Ok::<_, sorb::StateError>(bytes)
        };
        Ok(PyBytes::new(py, &py.detach(write).or_raise()?))
    }

    fn resume(&mut self, py: Python<'_>, save: &[u8]) -> PyResult<()> {
        self.begin_jump()?;
        py.detach(|| self.world.resume(&Save::read(save)?)).or_raise()
    }

    fn snapshot_into(&self, snapshot: &mut Snapshot) {
        self.world.snapshot_into(&mut snapshot.0);
    }

    fn rollback(&mut self, snapshot: &Snapshot) -> PyResult<()> {
        self.begin_jump()?;
        self.world.rollback(&snapshot.0).or_raise()
    }

    fn record(&mut self, every: Option<u32>) -> PyResult<()> {
        if self.recorder.is_some() {
            return Err(exception("StateError", "the world is being recorded already", Vec::new()));
        }
        self.recorder = Some(Recorder::new(&self.world, every).or_raise()?);
        Ok(())
    }

    fn end_recording<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let recorder = self
            .recorder
            .take()
            .ok_or_else(|| exception("StateError", "the world is not being recorded", Vec::new()))?;
        if let Some(error) = recorder.lost_key_frame() {
            return Err(exception("StateError", &error.to_string(), Vec::new()));
        }
        let mut bytes = Vec::new();
        recorder.recording().write(&mut bytes).or_raise()?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Draws the world: rows from top to bottom, three bytes a pixel.
    fn picture<'py>(
        &self,
        py: Python<'py>,
        size: (u32, u32),
        view: &str,
        camera: (Option<[f32; 3]>, Option<[f32; 3]>, Option<f32>),
    ) -> PyResult<Bound<'py, PyBytes>> {
        let name = |view: &View| format!("{view:?}").to_ascii_lowercase();
        let view = View::ALL.into_iter().find(|own| name(own) == view).ok_or_else(|| {
            let known: Vec<String> = View::ALL.iter().map(name).collect();
            let message = format!("view = \"{view}\" is none of {}", known.join(", "));
            exception("QueryError", &message, vec!["view".to_owned()])
        })?;
        let mut own = self.world.scene().viewpoint();
        let (eye, target, angle) = camera;
        own.eye = eye.map_or(own.eye, Vec3::from_array);
        own.target = target.map_or(own.target, Vec3::from_array);
        own.field_of_view_degrees = angle.unwrap_or(own.field_of_view_degrees);
        // Checked by the rules of scenes.
        self.world.scene().clone().with_camera(own).validate().or_raise()?;
        let image = py.detach(|| render::draw_world(&self.world, &own.into(), view, size.0, size.1));
        Ok(PyBytes::new(py, &image.pixels))
    }
}

fn no_column(name: &str) -> PyErr {
    exception("QueryError", &format!("no column `{name}`"), vec![name.to_owned()])
}

/// Rows of floats out of bytes; what is left at the end is no row.
fn rows_of<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [f32; N]> {
    let numbers = bytes.as_chunks::<4>().0.as_chunks::<N>().0.iter();
    numbers.map(|row| row.map(f32::from_ne_bytes))
}

fn floats_to_bytes(py: Python<'_>, values: impl IntoIterator<Item = f32>) -> Bound<'_, PyBytes> {
    let bytes: Vec<u8> = values.into_iter().flat_map(f32::to_ne_bytes).collect();
    PyBytes::new(py, &bytes)
}
