//! Numbers of bodies and sponges: how often each was taken before, and by what, if by anything.

/// The numbers of one kind, by what has them.
#[derive(Clone, Debug)]
pub(crate) struct Slots<K>(Vec<(u32, Option<K>)>);

impl<K: Copy> Slots<K> {
    /// From the generation of every number and what has it.
    pub(super) fn new(all: impl Iterator<Item = (u32, Option<K>)>) -> Self {
        Self(all.collect())
    }

    /// What has a number in a generation; none for a stale handle.
    pub(crate) fn of(&self, index: usize, generation: u32) -> Option<K> {
        let (own, kind) = self.0.get(index).copied()?;
        kind.filter(|_| own == generation)
    }

    /// Numbers that were ever taken.
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// Number and generation of what comes next.
    pub(super) fn next(&self) -> (u32, u32) {
        let free = self.0.iter().position(|(_, kind)| kind.is_none());
        let index = free.unwrap_or(self.0.len());
        (index as u32, self.0.get(index).map_or(0, |(generation, _)| *generation))
    }

    /// Something takes a number.
    pub(super) fn take(&mut self, index: usize, generation: u32, kind: K) {
        match self.0.get_mut(index) {
            Some(slot) => *slot = (generation, Some(kind)),
            None => self.0.push((generation, Some(kind))),
        }
    }

    /// What has a number becomes something else.
    pub(super) fn change(&mut self, index: usize, kind: K) {
        if let Some(slot) = self.0.get_mut(index) {
            slot.1 = Some(kind);
        }
    }

    /// What had a number in a generation is gone.
    pub(super) fn free(&mut self, index: usize, generation: u32) {
        if let Some(slot) = self.0.get_mut(index) {
            *slot = (generation.saturating_add(1), None);
        }
    }
}
