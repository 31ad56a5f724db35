//! For every control the particles in its tets.

use crate::{column::padded, cpu::Cpu, grid::neighbors::Neighbors};

/// Parts in which particles are sorted by the controls of their tets, at the same time. Their number is fixed: it must not depend on that
/// of the threads, and each holds a start for every control.
const PARTS: usize = 8;

/// Corners of the tets of a part of the particles, sorted by control.
#[derive(Clone, Default)]
struct Part {
    start: Vec<u32>,
    order: Vec<u32>,
}

impl Part {
    fn sort(&mut self, first: usize, corners: &[[u32; 4]], controls: usize) {
        let start = &mut self.start;
        start.resize(controls + 2, 0);
        let all = || (4 * first as u32..).zip(corners.as_flattened());
        let all = || all().filter(|(_, control)| (**control as usize) < controls);
        all().for_each(|(_, control)| start[*control as usize + 2] += 1);
        (2..start.len()).for_each(|row| start[row] += start[row - 1]);
        self.order.resize(start[controls + 1] as usize, 0);
        for (place, control) in all() {
            let next = &mut start[*control as usize + 1];
            self.order[*next as usize] = place;
            *next += 1;
        }
    }

    fn of(&self, control: usize) -> &[u32] {
        &self.order[self.start[control] as usize..self.start[control + 1] as usize]
    }
}

/// For every control the corners that it is of the tets of particles: four times the row of the particle, and the corner.
pub(super) fn list(
    cpu: &Cpu,
    corners: &[[u32; 4]],
    particles: usize,
    controls: usize,
    lists: &mut Neighbors,
) {
    let size = corners.len().div_ceil(PARTS).max(1);
    let mut parts = vec![Part::default(); PARTS];
    cpu.for_chunks_of(1, &mut parts[..], |index, parts| {
        for (part, index) in parts.iter_mut().zip(index..) {
            let rows = (index * size).min(corners.len())..((index + 1) * size).min(corners.len());
            part.sort(rows.start, &corners[rows], controls);
        }
    });
    lists.fill(cpu, padded(controls), 4 * particles as u32, |(): &mut (), control, list| {
        if control < controls {
            parts.iter().for_each(|part| list.extend(part.of(control)));
        }
    });
}
