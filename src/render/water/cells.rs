//! Points by the cells of a regular grid, for the search of neighbours.

use glam::Vec3;
use std::ops::Range;

/// Most cells of points that are far apart; they are longer then.
const MOST: f32 = 8e6;

/// Points that are looked at together.
pub(super) const LANES: usize = 4;

/// What cells are and where their points begin.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Table<'a> {
    pub(in crate::render) low: Vec3,
    /// One over the side of a cell (1/m).
    pub(in crate::render) inverse: f32,
    pub(in crate::render) sides: [usize; 3],
    /// First place of every cell, and the end of the last one.
    pub(in crate::render) start: &'a [u32],
}

/// Points, cell by cell.
pub(in crate::render) struct Cells {
    low: Vec3,
    inverse: f32,
    sides: [usize; 3],
    /// First place of every cell in the columns, and the end of the last one.
    start: Vec<u32>,
    /// Coordinates of the points from cell to cell (m), with [`LANES`] more that are nowhere.
    columns: [Vec<f32>; 3],
    /// Rows of the points, from cell to cell.
    rows: Vec<u32>,
}

impl Cells {
    /// Sorts finite points into cells of at least a side \[m\].
    pub(in crate::render) fn new(points: &[Vec3], side: f32) -> Self {
        let low = points.iter().fold(Vec3::INFINITY, |low, point| low.min(*point));
        let high = points.iter().fold(Vec3::NEG_INFINITY, |high, point| high.max(*point));
        let (low, high) = if points.is_empty() { (Vec3::ZERO, Vec3::ZERO) } else { (low, high) };
        let cells = ((high - low) / side + 1.0).element_product();
        let inverse = 1.0 / (side * libm::cbrtf((cells / MOST).max(1.0)));
        let sides = ((high - low) * inverse).to_array().map(|length| length as usize + 1);
        let cells: Vec<usize> = points
            .iter()
            .map(|point| {
                let [x, y, z] = ((*point - low) * inverse).to_array().map(|length| length as usize);
                (z * sides[1] + y) * sides[0] + x
            })
            .collect();
        let mut start = vec![0; sides[0] * sides[1] * sides[2] + 1];
        for cell in &cells {
            start[cell + 1] += 1;
        }
        for cell in 1..start.len() {
            start[cell] += start[cell - 1];
        }
        let mut next = start.clone();
        let mut columns = [(); 3].map(|()| vec![f32::INFINITY; points.len() + LANES]);
        let mut rows = vec![0; points.len()];
        for (row, (point, cell)) in points.iter().zip(cells).enumerate() {
            let place = next[cell] as usize;
            next[cell] += 1;
            rows[place] = row as u32;
            for (column, value) in columns.iter_mut().zip(point.to_array()) {
                column[place] = value;
            }
        }
        Self { low, inverse, sides, start, columns, rows }
    }

    /// The coordinates of the points at some places and [`LANES`] more.
    pub(super) fn coordinates(&self, places: Range<usize>) -> [&[f32]; 3] {
        [0, 1, 2].map(|axis| &self.columns[axis][places.start..places.end + LANES])
    }

    /// The cells themselves.
    #[cfg(feature = "gpu")]
    pub(in crate::render) fn table(&self) -> Table<'_> {
        Table { low: self.low, inverse: self.inverse, sides: self.sides, start: &self.start }
    }

    /// The rows of the points at some places.
    pub(in crate::render) fn rows(&self, places: Range<usize>) -> &[u32] {
        &self.rows[places]
    }

    fn cell(&self, point: Vec3) -> [isize; 3] {
        ((point - self.low) * self.inverse).to_array().map(|length| length as isize)
    }

    /// Whether no cell within two cells of a point is empty, and all of them have at least so many points.
    pub(super) fn are_full(&self, point: Vec3, least: f32) -> bool {
        let cell = self.cell(point);
        if (0..3).any(|axis| cell[axis] < 2 || cell[axis] + 2 >= self.sides[axis] as isize) {
            return false;
        }
        let mut count = 0;
        let mut full = true;
        self.around(point, |places, cells| {
            count += places.len();
            full &= self.start[cells].windows(2).all(|pair| pair[0] < pair[1]);
        });
        full && count as f32 >= least
    }

    /// Calls `visit` with the places of all points within two cells of a point, in a fixed order. `visit` also gets the
    /// bounds of their cells in `start`.
    pub(super) fn around(&self, point: Vec3, mut visit: impl FnMut(Range<usize>, Range<usize>)) {
        let cell = self.cell(point);
        let range = |axis: usize| {
            let last = self.sides[axis] as isize - 1;
            ((cell[axis] - 2).clamp(0, last) as usize, (cell[axis] + 2).clamp(0, last) as usize)
        };
        let ((x0, x1), (y0, y1), (z0, z1)) = (range(0), range(1), range(2));
        for z in z0..=z1 {
            for y in y0..=y1 {
                let row = (z * self.sides[1] + y) * self.sides[0];
                let (first, end) = (self.start[row + x0] as usize, self.start[row + x1 + 1] as usize);
                visit(first..end, row + x0..row + x1 + 2);
            }
        }
    }
}
