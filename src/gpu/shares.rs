//! The shares of CPU and device in a step, and the transfers between them.

use sorb_kernels::{
    column::Life, columns::Column, couple::weights::sources, kernel::Kernel, kernel_named, stage::Stage,
};

use crate::schedule::{
    Offload, Place, PlaceError, Plan, PlannedPhase, Verdict, offload::place_in, order::PlannedStage,
    plan::Work,
};

/// Consecutive stages at one place.
#[derive(Clone, Debug)]
pub(crate) struct Share {
    pub(crate) place: Place,
    pub(crate) stages: Vec<Stage>,
    /// Index of the first one in the plan.
    pub(crate) line: usize,
    /// Columns that these kernels need and that only the other side has.
    pub(crate) needs: Vec<Column>,
    /// Whether the particles are in the order of this step at its beginning.
    pub(crate) is_sorted: bool,
}

/// The shares of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    /// In order, with repetitions written out.
    pub(crate) all: Vec<Share>,
    /// Columns that the host fetches at the end of the step.
    pub(crate) fetched: Vec<Column>,
}

impl Shares {
    /// Whether the device runs all of it.
    pub(crate) fn are_all_on_gpu(&self) -> bool {
        !self.all.is_empty() && self.all.iter().all(|share| share.place == Place::Gpu)
    }

    /// Kernels of the device, in order, with repetitions written out.
    pub(crate) fn on_gpu(&self) -> impl Iterator<Item = &'static Kernel> + '_ {
        let shares = self.all.iter().filter(|share| share.place == Place::Gpu);
        shares.flat_map(Share::kernels)
    }
}

impl Share {
    /// Its kernels, in order.
    pub(crate) fn kernels(&self) -> impl Iterator<Item = &'static Kernel> + '_ {
        self.stages.iter().flat_map(Stage::kernels).copied()
    }
}

/// Columns with an up-to-date copy, by place.
#[derive(Clone, Debug)]
struct Fresh {
    host: Vec<Column>,
    device: Vec<Column>,
}

impl Fresh {
    /// After the upload of a state.
    fn at_upload() -> Self {
        let lives = |column: &Column| !column.life().is_rebuilt();
        Self { host: Column::ALL.to_vec(), device: Column::ALL.iter().copied().filter(lives).collect() }
    }

    fn at(&mut self, place: Place) -> (&mut Vec<Column>, &mut Vec<Column>) {
        match place {
            Place::Cpu => (&mut self.host, &mut self.device),
            Place::Gpu => (&mut self.device, &mut self.host),
        }
    }

    /// Columns that must be transferred to a place before it reads `column`; they are up to date there from then on.
    fn bring(&mut self, column: Column, place: Place) -> Vec<Column> {
        let (here, _) = self.at(place);
        if here.contains(&column) {
            return Vec::new();
        }
        here.push(column);
        let Some((lists, points)) = sources(column) else { return vec![column] };
        // A device computes weights where it needs them: points suffice. The host has to compute them first.
        let mut inputs = points.to_vec();
        if place == Place::Cpu {
            inputs.push(lists);
        }
        let mut sent: Vec<Column> = inputs.into_iter().flat_map(|source| self.bring(source, place)).collect();
        if place == Place::Cpu {
            sent.push(column);
        }
        sent
    }

    fn write(&mut self, column: Column, place: Place) {
        let (here, there) = self.at(place);
        there.retain(|other| *other != column);
        if !here.contains(&column) {
            here.push(column);
        }
    }
}

/// Columns that a kernel reads and writes at its place. Particles are brought back from the order of the step together, with
/// their identity.
fn moved(kernel: &Kernel) -> (Vec<Column>, Vec<Column>) {
    let (mut reads, mut writes) = (kernel.reads.to_vec(), kernel.writes.to_vec());
    if kernel.returns_fluid() {
        reads.push(Column::FluidId);
        writes.push(Column::FluidId);
    }
    (reads, writes)
}

impl Plan {
    /// Whether a phase runs.
    pub(crate) fn runs(&self, name: &str) -> bool {
        self.lines().iter().any(|line| line.name == name && line.verdict == Verdict::Runs)
    }

    /// The kernels that run on a GPU, of those that run.
    ///
    /// # Errors
    /// Kernels are asked for at places where they cannot be.
    pub(crate) fn kernels_on_gpu(&self, offload: &Offload) -> Result<Vec<&'static str>, PlaceError> {
        let kernel = |line: &PlannedPhase| match line.work {
            Work::Kernel(kernel) => (line.verdict == Verdict::Runs).then_some(kernel),
            Work::Host(_) => None,
        };
        let kernels: Vec<&'static Kernel> = self.lines().iter().filter_map(kernel).collect();
        match offload {
            Offload::Cpu => Ok(Vec::new()),
            Offload::Gpu | Offload::Auto => Ok(kernels.iter().map(|kernel| kernel.name).collect()),
            Offload::From(first) => Ok(self.kernels_from(first, &kernels)),
            Offload::Each(list) => self.kernels_of_list(list, &kernels),
        }
    }

    /// A kernel and all active kernels after it.
    fn kernels_from(&self, first: &'static str, kernels: &[&'static Kernel]) -> Vec<&'static str> {
        let first = self.first_of_rounds(first);
        let Some(first) = kernels.iter().position(|kernel| kernel.name == first) else { return Vec::new() };
        // A search right after the sort includes it.
        let follows = first > 0 && kernels[first].searches_fluid() && kernels[first - 1].sorts_fluid();
        let all = &kernels[first - usize::from(follows)..];
        // The cells are not transferred.
        let is_sorted_there = all.iter().any(|kernel| kernel.sorts_fluid());
        let stays = |kernel: &&&Kernel| is_sorted_there || !kernel.searches_fluid();
        all.iter().filter(stays).map(|kernel| kernel.name).collect()
    }

    /// The active kernels that a list places on a GPU.
    fn kernels_of_list(
        &self,
        list: &[(&'static str, Place)],
        kernels: &[&'static Kernel],
    ) -> Result<Vec<&'static str>, PlaceError> {
        if let Some((name, _)) = list.iter().find(|(name, _)| kernel_named(name).is_none()) {
            return Err(PlaceError::Unknown(name));
        }
        let place = |kernel: &Kernel| place_in(list, kernel);
        if let Some(sort) = kernels.iter().find(|kernel| kernel.sorts_fluid()) {
            let mut searches = kernels.iter().filter(|kernel| kernel.searches_fluid());
            if let Some(kernel) = searches.find(|kernel| place(kernel) != place(sort)) {
                return Err(PlaceError::BesideSort {
                    kernel: kernel.name,
                    place: place(kernel),
                    sort: sort.name,
                });
            }
        }
        for group in self.rounds() {
            let in_group = |kernel: &&&Kernel| group.iter().any(|line| line.name == kernel.name);
            let mut members = kernels.iter().filter(in_group);
            let Some(with) = members.next() else { continue };
            if let Some(kernel) = members.find(|kernel| place(kernel) != place(with)) {
                return Err(PlaceError::Apart { kernel: kernel.name, place: place(kernel), with: with.name });
            }
        }
        Ok(kernels.iter().filter(|kernel| place(kernel) == Place::Gpu).map(|kernel| kernel.name).collect())
    }

    /// Groups of active lines that are repeated until they have converged.
    fn rounds(&self) -> impl Iterator<Item = Vec<&PlannedPhase>> {
        self.groups()
            .filter(|group| group[0].until_converged)
            .map(|group| group.iter().filter(|line| line.verdict == Verdict::Runs).collect())
    }

    /// The first kernel of the group in which this one is repeated until convergence; otherwise the kernel.
    fn first_of_rounds(&self, name: &'static str) -> &'static str {
        let group = self.rounds().find(|group| group.iter().any(|line| line.name == name));
        group.map_or(name, |group| group[0].name)
    }

    /// The shares of CPU and device in the placed plan; `read_by_host` are columns that the host reads after a step.
    pub(crate) fn shares(&self, read_by_host: &[Column]) -> Shares {
        let on_gpu = self.placement().map_or(&[][..], |placement| &placement.on_gpu);
        self.shares_with(on_gpu, read_by_host)
    }

    /// The shares if the device has these kernels.
    pub(crate) fn shares_with(&self, on_gpu: &[&str], read_by_host: &[Column]) -> Shares {
        let stages = self.in_order();
        let mut fresh = Fresh::at_upload();
        // Data of one step remain on the device for the next: only the second step shows the transfers of all others.
        shares_of(&stages, on_gpu, &mut fresh, read_by_host);
        shares_of(&stages, on_gpu, &mut fresh, read_by_host)
    }
}

/// The shares of a step that begins with these columns up to date.
fn shares_of(stages: &[PlannedStage], on_gpu: &[&str], fresh: &mut Fresh, read_by_host: &[Column]) -> Shares {
    let mut shares = Shares::default();
    let mut is_sorted = false;
    let mut host = Vec::new();
    for planned in stages {
        let (stage, lines) = match planned {
            PlannedStage::Kernels(stage, lines) => (stage, lines),
            PlannedStage::Host(phase) => {
                host.push(phase);
                continue;
            }
        };
        let is_there = |kernel: &&Kernel| on_gpu.contains(&kernel.name);
        let place = if stage.kernels().iter().any(is_there) { Place::Gpu } else { Place::Cpu };
        if shares.all.last().is_none_or(|last| last.place != place) {
            shares.all.push(Share {
                place,
                stages: Vec::new(),
                line: lines[0],
                needs: Vec::new(),
                is_sorted,
            });
        }
        let Some(share) = shares.all.last_mut() else { continue };
        for kernel in stage.kernels() {
            let (reads, writes) = moved(kernel);
            for column in reads {
                share.needs.extend(fresh.bring(column, place));
            }
            writes.into_iter().for_each(|column| fresh.write(column, place));
            is_sorted = kernel.sorts_fluid() || is_sorted && !kernel.returns_fluid();
        }
        share.stages.push(stage.clone());
    }
    // The host stores the state, reads it, and has phases of its own.
    let state = |column: &Column| column.life() == Life::State || read_by_host.contains(column);
    let mut wanted: Vec<Column> = Column::ALL.iter().copied().filter(state).collect();
    host.iter().for_each(|phase| wanted.extend(phase.reads));
    if !shares.all.is_empty() {
        shares.fetched = wanted.into_iter().flat_map(|column| fresh.bring(column, Place::Cpu)).collect();
    }
    for column in host.iter().flat_map(|phase| phase.writes) {
        fresh.write(*column, Place::Cpu);
    }
    shares
}
