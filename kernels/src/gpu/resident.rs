//! The columns of a world on a device: one buffer each, and what the passes need beside them.

use std::{collections::BTreeMap, sync::Arc};

use wgpu::{Buffer, BufferUsages};

use super::{
    answer::{BODY_SPEED_AT, CLOCK_BYTES, WRENCH_BYTES},
    bodies::{self, DeviceBody},
    capacities::{Capacities, capacities},
    cells::{Grid, PAGE_CELLS},
    device::Gpu,
    error::GpuError,
    form::{Form, is_plain, plain_buffers, rows_of},
    groups::{BOX_ROWS, SOLVE_SUM_ROWS, maximum_groups, motion_rows, rows_bytes},
    image_layout,
    layout::{ROW_BYTES, Value, WORD_BYTES},
    pack::{self, BATCH_STRIDE, BATCHES, Batch, NodeTraits, SPONGES, StepParams},
    stars::{self, RANGES},
    sum_layout::{GroupSums, sum_groups},
};
use crate::{
    asleep::Asleep,
    body::Body,
    clock::StepLimits,
    columns::{Column, Columns, RowCounts},
    params::{Params, SpongeParams},
    pbd::meeting::pair_radius,
    tets::rows::TET_CORNERS,
};

/// Most cells of a grid: their counts and starts are one binding each.
const MAXIMUM_CELLS: u64 = 1 << 28;

/// Columns on a device. State stays there from step to step.
#[derive(Debug)]
pub struct Resident {
    pub(super) gpu: Arc<Gpu>,
    pub(super) buffers: BTreeMap<&'static str, Buffer>,
    pub(super) rows: RowCounts,
    pub(super) capacities: Capacities,
    pub(super) limits: StepLimits,
    pub(super) params: Params,
    pub(super) grids: [Grid; 5],
    /// First node of every sponge.
    pub(super) first_nodes: Vec<usize>,
    /// First row and rows of every batch.
    pub(super) batches: [Batch; BATCHES],
    /// Whether particles are where `sph::advect` leaves them (false) or where `grid::sort_fluid` does (true).
    pub(super) sorted: bool,
    /// Steps since the time was set.
    pub(super) steps: u32,
    /// Whether the clock has chosen the next step.
    pub(super) has_begun: bool,
    /// How often buffers were replaced, so that programs know when to bind anew.
    pub(super) replaced: u32,
    /// Whether passes that can be are one dispatch.
    pub(super) is_fused: bool,
    /// Where the host reads clock and wrenches after a batch.
    pub(super) answer: Buffer,
}

impl Resident {
    /// Makes room for the columns of a scene, and uploads what never changes. State is uploaded by
    /// [`Self::upload`].
    ///
    /// # Errors
    /// There is not enough memory, or a buffer would exceed a limit of the device.
    pub fn new(
        gpu: &Arc<Gpu>,
        columns: &Columns,
        params: &Params,
        limits: StepLimits,
    ) -> Result<Self, GpuError> {
        if params.sponges.len() > SPONGES {
            return Err(GpuError::TooManySponges { sponges: params.sponges.len(), limit: SPONGES });
        }
        let rows = columns.rows;
        let grids = grids(gpu, params, rows);
        let (batches, tet_sponge) = pack::batches(&columns.nodes.topology);
        let answer = gpu.guarded(None, || {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("answer"),
                size: CLOCK_BYTES + rows.bodies as u64 * WRENCH_BYTES,
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        let mut resident = Self {
            gpu: Arc::clone(gpu),
            buffers: BTreeMap::new(),
            rows,
            capacities: capacities(params, rows),
            limits,
            params: params.clone(),
            grids,
            first_nodes: stars::first_nodes(columns, params),
            batches,
            sorted: false,
            steps: 0,
            has_begun: false,
            replaced: 0,
            is_fused: !gpu.has_subgroups,
            answer,
        };
        for (name, size, usage) in resident.layout(columns) {
            resident.allocate(name, size, usage)?;
        }
        resident.fill_constants(columns, &tet_sponge);
        Ok(resident)
    }

    /// The device.
    #[must_use]
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// Buffers of positions and velocities of the particles: rows of four floats, as in the columns, where the last
    /// step left them. For a renderer on the same device; it must not write them.
    #[must_use]
    pub fn particle_buffers(&self) -> (&Buffer, &Buffer) {
        let name = |sorted, plain| if self.sorted { sorted } else { plain };
        (
            self.buffer(name("fluid_position", "fluid_position_next")),
            self.buffer(name("fluid_velocity", "fluid_velocity_next")),
        )
    }

    /// Buffer of the share of every particle that a sponge holds, in the order of their positions; none in a scene without sponges or
    /// fluid. For a renderer on the same device; it must not write it.
    #[must_use]
    pub fn interior_buffer(&self) -> Option<&Buffer> {
        self.plain_buffer(Column::FluidInterior)
            .filter(|(_, _, bytes)| *bytes > 0)
            .map(|(_, name, _)| self.buffer(name))
    }

    /// A column that is a plain array, with its buffer and its bytes.
    pub(super) fn plain_buffer(&self, column: Column) -> Option<(Column, &'static str, usize)> {
        let size = rows_of(&self.params, self.rows, column) * column.element().bytes();
        is_plain(column).then(|| (column, Form::Plain.buffer(column, self.sorted), size))
    }

    /// Whether passes of programs that are bound from now on are one dispatch where they can be; they are, unless they are timed.
    pub fn set_fused(&mut self, is_fused: bool) {
        self.is_fused = is_fused && !self.gpu.has_subgroups;
    }

    /// Bytes of all buffers.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.buffers.values().map(Buffer::size).sum()
    }

    /// A buffer of the layout.
    pub(super) fn buffer(&self, name: &'static str) -> &Buffer {
        // Every name in the table of twins is in the layout: the tests bind every pass.
        &self.buffers[name]
    }

    /// Name, bytes and use of every buffer.
    pub(super) fn layout(&self, columns: &Columns) -> Vec<(&'static str, u64, BufferUsages)> {
        let RowCounts { fluid, nodes, tets, bodies } = self.rows;
        let coupled = fluid > 0 && nodes > 0;
        let (fluid, nodes, body_rows) = (fluid as u64, nodes as u64, bodies as u64);
        // Rows of what only a scene with both has.
        let controls = if coupled { nodes } else { 0 };
        let is_barycentric = coupled && self.params.is_barycentric;
        let (cornered, corner_lists) = if is_barycentric { (fluid, nodes) } else { (0, 0) };
        let solved = if self.params.fluid.incompressible.is_some() { fluid } else { 0 };
        let viscous_rows = if self.params.fluid.implicit_viscosity.is_some() { fluid } else { 0 };
        let cells = |grid: &Grid, rows: u64| if rows > 0 { grid.pages() * u64::from(PAGE_CELLS) } else { 0 };
        let touching = if self.params.has_touch() { nodes } else { 0 };
        let stars = stars::star_words(&columns.nodes, self.rows.nodes, self.params.has_touch());
        let [fluid_cells, control_cells] = [cells(&self.grids[0], fluid), cells(&self.grids[1], controls)];
        let pair_cells = cells(&self.grids[2], touching);
        let page_sums = |cells: u64| WORD_BYTES * cells / u64::from(PAGE_CELLS);
        let sponges = self.params.sponges.len() as u64;
        let mirrors = self.params.fluid.divergence().is_some();
        let planes = bodies::plane_count(&columns.bodies.states.0) as u64;
        let (plain, uniform) = (BufferUsages::STORAGE, BufferUsages::UNIFORM);
        let column = |column: Column, is_there: bool| {
            let form = Form::of(column);
            let bytes = if is_there { form.bytes(column, self.rows, self.capacities) as u64 } else { 0 };
            (form.buffer(column, true), bytes, plain)
        };
        let words = |name: &'static str, count: u64| (name, count * WORD_BYTES, plain);
        let rows = |name: &'static str, count: u64| (name, count * ROW_BYTES, plain);
        let own = vec![
            ("params", StepParams::BYTES, uniform),
            ("clock", CLOCK_BYTES, uniform | plain),
            ("sponges", SPONGES as u64 * SpongeParams::BYTES, uniform | plain),
            ("fluid_grid", Grid::BYTES, uniform | plain),
            ("control_grid", Grid::BYTES, uniform | plain),
            ("pair_grid", Grid::BYTES, uniform | plain),
            ("batch", BATCH_STRIDE * BATCHES as u64, uniform | plain),
            column(Column::FluidExtremes, true),
            column(Column::FluidPressureSolve, true),
            ("solve_sums", maximum_groups(solved, self.gpu.busy_threads) * rows_bytes(SOLVE_SUM_ROWS), plain),
            column(Column::FluidViscositySolve, true),
            rows("viscosity_sums", maximum_groups(viscous_rows, self.gpu.busy_threads)),
            words("fluid_cells", fluid),
            words("fluid_slots", fluid),
            words("fluid_grouped", fluid),
            words("fluid_counts", fluid_cells),
            words("fluid_starts", fluid_cells),
            ("fluid_page_sums", page_sums(fluid_cells), plain),
            column(Column::FluidNeighbors, true),
            column(Column::FluidControls, coupled),
            column(Column::FluidCorners, is_barycentric),
            column(Column::FluidShares, is_barycentric),
            column(Column::ControlCorners, is_barycentric),
            words("node_control", corner_lists),
            words("corner_counts", corner_lists),
            words("corner_places", cornered * TET_CORNERS as u64),
            words("node_stars", stars as u64),
            rows("node_rest", touching),
            column(Column::NodePairs, self.params.has_touch()),
            words("pair_cells", touching),
            words("pair_slots", touching),
            words("pair_grouped", touching),
            words("pair_counts", pair_cells),
            words("pair_starts", pair_cells),
            ("pair_page_sums", page_sums(pair_cells), plain),
            words("sponge_ranges", sponges * RANGES as u64 * 2),
            ("sponge_boxes", sponges * rows_bytes(BOX_ROWS), plain),
            rows("sponge_motions", motion_rows(self.params.sponges.len(), self.rows.nodes) as u64),
            ("node_traits", nodes * NodeTraits::BYTES, plain),
            rows("tets", tets as u64),
            words("tet_sponge", tets as u64),
            words("tet_weight", tets as u64),
            words("control_cells", controls),
            words("control_slots", controls),
            words("control_grouped", controls),
            words("control_counts", control_cells),
            words("control_starts", control_cells),
            ("control_page_sums", page_sums(control_cells), plain),
            column(Column::ControlFluid, coupled),
            column(Column::BodyStates, true),
            rows("planes", planes),
            column(Column::BodyFluidWrenches, true),
            column(Column::BodyNodeWrenches, true),
            column(Column::BodyPressureWrenches, mirrors),
            ("body_wrenches", body_rows * WRENCH_BYTES, plain),
            words("node_mass", nodes),
            ("partial_sums", sum_groups(self.rows) * GroupSums::BYTES, plain),
            ("totals", 3 * GroupSums::BYTES, plain),
        ];
        let columns = plain_buffers(&self.params, self.rows);
        let own = own.into_iter().chain(image_layout::buffers(self.rows, self.capacities, &self.grids));
        own.chain(columns.into_iter().map(|(name, size)| (name, size, plain))).collect()
    }

    /// Bytes of a buffer for some bytes.
    pub(super) fn buffer_size(size: u64) -> u64 {
        size.max(DeviceBody::BYTES).next_multiple_of(16)
    }

    /// Makes a buffer, zeroed. One row at least: nothing can be bound to an empty buffer.
    pub(super) fn allocate(
        &mut self,
        name: &'static str,
        size: u64,
        usage: BufferUsages,
    ) -> Result<(), GpuError> {
        let size = Self::buffer_size(size);
        let limits = &self.gpu.limits;
        let maximum = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if size > maximum {
            let reason = format!("the adapter binds at most {maximum} bytes");
            return Err(GpuError::OutOfMemory { buffer: name, needed: size, reason });
        }
        let usage = usage | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let buffer = self.gpu.guarded(Some((name, size)), || {
            let descriptor =
                wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
            self.gpu.device.create_buffer(&descriptor)
        })?;
        self.buffers.insert(name, buffer);
        Ok(())
    }

    fn fill_constants(&self, columns: &Columns, tet_sponge: &[u32]) {
        let nodes = &columns.nodes;
        self.fill_grids();
        if self.params.has_touch() {
            self.write("node_rest", bytemuck::cast_slice(&nodes.rest[..self.rows.nodes]));
        }
        self.write("batch", bytemuck::cast_slice(&pack::batch_words(&self.batches)));
        self.write("tets", bytemuck::cast_slice(&nodes.topology.tets));
        self.write("tet_sponge", bytemuck::cast_slice(tet_sponge));
        self.write("tet_weight", bytemuck::cast_slice(&nodes.topology.weights));
        let value = |values: &[f32], node: usize| values.get(node).copied().unwrap_or(0.0);
        let traits: Vec<u32> = (0..self.rows.nodes)
            .flat_map(|node| {
                let (suction, interior) = (value(&nodes.suction, node), value(&nodes.interior, node));
                NodeTraits { sponge: nodes.sponge[node], suction, interior }.words()
            })
            .collect();
        self.write("node_traits", bytemuck::cast_slice(&traits));
        let stars = stars::stars(nodes, self.rows.nodes, self.params.has_touch());
        self.write("node_stars", bytemuck::cast_slice(&stars));
        self.fill_ranges(columns);
        self.fill_params();
    }

    /// The sponges, and cells.
    pub(super) fn fill_grids(&self) {
        self.write("sponges", bytemuck::cast_slice(&pack::sponges(&self.params, &self.first_nodes)));
        self.write("fluid_grid", bytemuck::cast_slice(&self.grids[0].words()));
        self.write("control_grid", bytemuck::cast_slice(&self.grids[1].words()));
        self.write("pair_grid", bytemuck::cast_slice(&self.grids[2].words()));
        self.write("image_grid", bytemuck::cast_slice(&self.grids[3].words()));
        self.write("image_line", bytemuck::cast_slice(&self.grids[4].words()));
    }

    /// Where the nodes of every sponge are, and which others it touches.
    pub(super) fn fill_ranges(&self, columns: &Columns) {
        let ranges = stars::sponge_ranges(&columns.nodes, self.params.sponges.len());
        self.write("sponge_ranges", bytemuck::cast_slice(&ranges));
    }

    /// Parameters, which hold the length of lists.
    pub(super) fn fill_params(&self) {
        let params = StepParams::new(&self.params, self.rows, &self.limits, self.capacities);
        self.write("params", bytemuck::cast_slice(&params.words()));
    }

    /// Writes the beginning of a buffer, before whatever is submitted next.
    pub(super) fn write(&self, name: &'static str, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.gpu.queue.write_buffer(self.buffer(name), 0, bytes);
        }
    }

    /// Shapes, poses and velocities of the bodies, and the largest speed of their surfaces, which bounds the next step.
    pub fn upload_bodies(&mut self, bodies: &[Body]) {
        let fastest = bodies.iter().map(Body::fastest).fold(0.0, f32::max);
        let (words, planes) = bodies::pack(bodies);
        self.write("body_states", bytemuck::cast_slice(&words));
        self.write("planes", bytemuck::cast_slice(&planes));
        self.gpu.queue.write_buffer(self.buffer("clock"), BODY_SPEED_AT, &fastest.to_ne_bytes());
        // The clock has chosen the next step before the bodies moved.
        let reach = self.limits.reach_of_bodies(self.params.fluid.smoothing.support_radius);
        if fastest * self.limits.constant > reach {
            self.has_begun = false;
        }
    }

    /// Another acceleration of free fall \[m/s^2\] for the next steps.
    pub fn set_gravity(&mut self, gravity: glam::Vec3) {
        self.params.gravity = gravity;
        self.fill_params();
    }

    /// Goes on without sponges whose nodes are asleep, and with those that are no longer; `limits` are those of what is awake. The
    /// fluid `is_outside` of all sponges if they sleep and it does not. The time has to be set anew.
    pub fn set_asleep(&mut self, asleep: &Asleep, limits: StepLimits, is_outside: bool) {
        self.params.asleep = asleep.clone();
        self.limits = limits;
        self.has_begun = false;
        self.write("sponges", bytemuck::cast_slice(&pack::sponges(&self.params, &self.first_nodes)));
        self.fill_params();
        // Phases that are left out do not clear what they wrote before.
        let mut stale = vec!["body_fluid_wrenches", "body_node_wrenches"];
        if is_outside {
            stale.extend(["fluid_interior", "fluid_solid_yield"]);
        }
        for name in stale {
            self.write(name, &vec![0; self.buffer(name).size() as usize]);
        }
    }
}

/// Cells over particles, controls, nodes that touch and images, and the line of the particles.
pub(super) fn grids(gpu: &Gpu, params: &Params, rows: RowCounts) -> [Grid; 5] {
    // Counts and starts are padded to pages.
    let maximum = (gpu.limits.max_storage_buffer_binding_size / 4).saturating_sub(8192).min(MAXIMUM_CELLS);
    [
        Grid::new(params.domain, params.fluid.list_radius(), rows.fluid, maximum),
        Grid::new(params.domain, params.coupling.support_radius, rows.nodes, maximum),
        // Where nothing can touch, its buffers are empty and no pass takes it.
        Grid::new(
            params.domain,
            if params.has_touch() { pair_radius(params) } else { 1.0 },
            rows.nodes,
            maximum,
        ),
        image_layout::cells(params, rows, maximum),
        Grid::line(rows.fluid),
    ]
}
