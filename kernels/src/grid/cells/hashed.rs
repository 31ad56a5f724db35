//! An unbounded domain: Morton keys, a sort, a list of the occupied cells, and a hash table of that list, made by a
//! second sort \[WK20, section 3\].

use crate::{
    cpu::Cpu,
    grid::{scan, sort::Sort},
};

/// Cells on either side of the origin.
const CELL_LIMIT: f32 = (1 << 20) as f32;

/// The scheme of Winchenbach and Kolb for an unbounded domain.
#[derive(Clone, Debug, Default)]
pub(super) struct Hashed {
    scale: f32,
    keys: Vec<u64>,
    /// Morton keys in the order of the cells of the list.
    cell_keys: Vec<u64>,
    /// Occupied cells, ordered by hash: first and last row.
    pub(super) cells: Vec<[u32; 2]>,
    /// First and last cell of every hash.
    pub(super) table: Vec<[u32; 2]>,
    flags: Vec<u32>,
    page_sums: Vec<u32>,
    hashes: Vec<u64>,
    cell_order: Vec<u32>,
    sort: Sort,
}

impl Hashed {
    pub(super) fn build(&mut self, cpu: &Cpu, points: &[[f32; 4]], support: f32, order: &mut Vec<u32>) {
        self.scale = 1.0 / support;
        let scale = self.scale;
        self.keys.resize(points.len(), 0);
        cpu.for_chunks(&mut self.keys[..], |first, keys| {
            for (key, point) in keys.iter_mut().zip(&points[first..]) {
                *key = morton([0, 1, 2].map(|axis| cell(point[axis], scale)));
            }
        });
        self.sort.stable_by_key(cpu, &self.keys, order);
        self.list_cells(cpu, order);
        self.hash_cells(cpu);
    }

    /// Occupied cells in the order of their Morton keys: a flag where the key changes, compacted by prefix sums.
    fn list_cells(&mut self, cpu: &Cpu, order: &[u32]) {
        let keys = &self.keys;
        let begins = |row: usize| row == 0 || keys[order[row] as usize] != keys[order[row - 1] as usize];
        self.flags.resize(order.len(), 0);
        cpu.for_chunks(&mut self.flags[..], |first, flags| {
            flags.iter_mut().enumerate().for_each(|(row, flag)| *flag = u32::from(begins(first + row)));
        });
        let count = scan::exclusive(cpu, &mut self.flags, &mut self.page_sums) as usize;
        self.cell_keys.clear();
        self.cell_keys.resize(count, 0);
        self.cells.clear();
        self.cells.resize(count, [0; 2]);
        for row in (0..order.len()).filter(|row| begins(*row)) {
            let cell = self.flags[row] as usize;
            self.cell_keys[cell] = keys[order[row] as usize];
            self.cells[cell][0] = row as u32;
            if cell > 0 {
                self.cells[cell - 1][1] = row as u32;
            }
        }
        if let Some(last) = self.cells.last_mut() {
            last[1] = order.len() as u32;
        }
    }

    /// Sorts the cells by hash, and stores the first cell of every hash.
    fn hash_cells(&mut self, cpu: &Cpu) {
        let size = (self.keys.len() as u64 + 1).next_power_of_two();
        self.hashes.clear();
        self.hashes.extend(self.cell_keys.iter().map(|key| hash(*key) % size));
        self.sort.stable_by_key(cpu, &self.hashes, &mut self.cell_order);
        self.cells = self.cell_order.iter().map(|cell| self.cells[*cell as usize]).collect();
        self.cell_keys = self.cell_order.iter().map(|cell| self.cell_keys[*cell as usize]).collect();
        self.table.clear();
        self.table.resize(size as usize, [0; 2]);
        for (row, cell) in self.cell_order.iter().enumerate() {
            let entry = &mut self.table[self.hashes[*cell as usize] as usize];
            if entry[1] == 0 {
                entry[0] = row as u32;
            }
            entry[1] = row as u32 + 1;
        }
    }

    pub(super) fn spans(&self, low: [f32; 3], high: [f32; 3], spans: &mut Vec<[u32; 2]>) {
        if self.table.is_empty() {
            return;
        }
        let from = [0, 1, 2].map(|axis| cell(low[axis], self.scale));
        let to = [0, 1, 2].map(|axis| cell(high[axis], self.scale));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                for x in from[0]..=to[0] {
                    let key = morton([x, y, z]);
                    let [first, last] = self.table[(hash(key) % self.table.len() as u64) as usize];
                    for row in first..last {
                        // Different cells may share a hash: a short run of cells, distinguished by their keys.
                        if self.cell_keys[row as usize] == key {
                            spans.push(self.cells[row as usize]);
                        }
                    }
                }
            }
        }
    }
}

/// Cell of a coordinate, counted from 2^20 cells below the origin.
fn cell(value: f32, scale: f32) -> u32 {
    ((value * scale).floor().clamp(-CELL_LIMIT, CELL_LIMIT - 1.0) + CELL_LIMIT) as u32
}

/// Interleaves 21 bits of every coordinate.
fn morton(cell: [u32; 3]) -> u64 {
    let spread = |value: u32| {
        let mut bits = u64::from(value) & 0x1f_ffff;
        bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
        bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
        bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
        bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
        (bits | bits << 2) & 0x1249_2492_4924_9249
    };
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

/// Multiplicative hash: the upper bits of the product depend on all bits of the key.
fn hash(key: u64) -> u64 {
    key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 24
}
