//! Cases that run at the same time.

use std::{
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

use sorb_validation::{Case, Outcome, Setting};

use crate::error::CliError;

/// Threads of each of some cases that run at the same time; none where there is one case, which has all.
pub(super) fn threads_of_each(jobs: u8) -> Option<usize> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    (jobs > 1).then(|| (cores / usize::from(jobs)).max(1))
}

/// Runs cases, and tells each outcome in the order of the cases as soon as those before it are told.
///
/// # Errors
/// Those of `tell`; cases that run are awaited, and no further ones begin.
pub(super) fn in_order(
    jobs: u8,
    runs: &[(&'static Case, Setting)],
    mut tell: impl FnMut(Outcome) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..jobs {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                while let Some((index, (case, setting))) = take(next, runs) {
                    if sender.send((index, sorb_validation::run(case, setting))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut outcomes: Vec<Option<Outcome>> = runs.iter().map(|_| None).collect();
        let mut told = 0;
        let result = receiver.iter().try_for_each(|(index, outcome)| {
            outcomes[index] = Some(outcome);
            while let Some(outcome) = outcomes.get_mut(told).and_then(Option::take) {
                told += 1;
                tell(outcome)?;
            }
            Ok(())
        });
        // Those that have not begun never do.
        next.store(runs.len(), Ordering::Relaxed);
        result
    })
}

/// The next run that nobody has taken.
fn take<'a, T>(next: &AtomicUsize, runs: &'a [T]) -> Option<(usize, &'a T)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    runs.get(index).map(|run| (index, run))
}
