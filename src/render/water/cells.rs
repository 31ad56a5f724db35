//! Points by the cells of a regular grid, for the search of neighbours.

use glam::Vec3;

/// Most cells of points that are far apart; they are longer then.
const MOST: f32 = 8e6;

/// Rows of points, cell by cell.
pub(super) struct Cells {
    low: Vec3,
    inverse: f32,
    sides: [usize; 3],
    /// First place of every cell in `rows`, and the end of the last one.
    start: Vec<u32>,
    rows: Vec<u32>,
}

impl Cells {
    /// Sorts finite points into cells of at least a side \[m\].
    pub(super) fn new(points: &[Vec3], side: f32) -> Self {
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
        let mut rows = vec![0; points.len()];
        for (row, cell) in cells.into_iter().enumerate() {
            rows[next[cell] as usize] = row as u32;
            next[cell] += 1;
        }
        Self { low, inverse, sides, start, rows }
    }

    /// Calls `visit` with the rows of all points within two cells of a point, in a fixed order.
    pub(super) fn around(&self, point: Vec3, mut visit: impl FnMut(&[u32])) {
        let cell = ((point - self.low) * self.inverse).to_array().map(|length| length as isize);
        let range = |axis: usize| {
            let last = self.sides[axis] as isize - 1;
            ((cell[axis] - 2).clamp(0, last) as usize, (cell[axis] + 2).clamp(0, last) as usize)
        };
        let ((x0, x1), (y0, y1), (z0, z1)) = (range(0), range(1), range(2));
        for z in z0..=z1 {
            for y in y0..=y1 {
                let row = (z * self.sides[1] + y) * self.sides[0];
                let (first, end) = (self.start[row + x0] as usize, self.start[row + x1 + 1] as usize);
                if first < end {
                    visit(&self.rows[first..end]);
                }
            }
        }
    }
}
