// Cells over points: a dense grid, or a torus where the points may lie anywhere.
//
// On an axis that wraps, cells repeat: distant points may share one, and the distance test separates them. On the others,
// points outside are in the outermost cell.

// Distances in cells that rounding may hide: of the point, and of what it is compared with.
fn slack(coordinate: f32) -> f32 {
    return 0.002 + abs(coordinate) * 4.0e-7;
}

fn coordinate_of(grid: Grid, value: f32, axis: u32) -> f32 {
    return (value - grid.origin[axis]) * grid.inverse_edge;
}

// A cell by its coordinate; not yet wrapped, but clamped to the grid where it does not wrap.
fn whole_cell(grid: Grid, coordinate: f32, axis: u32) -> i32 {
    let cell = i32(clamp(floor(coordinate), -1.0e9, 1.0e9));
    if (grid.wrap[axis] != 0u) {
        return cell;
    }
    return clamp(cell, 0, i32(grid.size[axis]) - 1);
}

fn wrapped(grid: Grid, cell: i32, axis: u32) -> u32 {
    if (grid.wrap[axis] != 0u) {
        return bitcast<u32>(cell) & (grid.size[axis] - 1u);
    }
    return bitcast<u32>(cell);
}

// Index of the cell of a point.
fn cell_of(grid: Grid, point: vec3<f32>) -> u32 {
    let x = wrapped(grid, whole_cell(grid, coordinate_of(grid, point.x, 0u), 0u), 0u);
    let y = wrapped(grid, whole_cell(grid, coordinate_of(grid, point.y, 1u), 1u), 1u);
    let z = wrapped(grid, whole_cell(grid, coordinate_of(grid, point.z, 2u), 2u), 2u);
    return (z * grid.size.y + y) * grid.size.x + x;
}

// First and last cell of an axis that a ball may intersect.
fn cells_around(grid: Grid, coordinate: f32, reach: f32, axis: u32) -> vec2<i32> {
    let low = whole_cell(grid, coordinate - reach, axis);
    let high = whole_cell(grid, coordinate + reach, axis);
    // No cell twice, where a ball is wider than the torus.
    return vec2<i32>(low, min(high, low + i32(grid.size[axis]) - 1));
}

// Distance in cells of a coordinate from a slab of cells.
fn slab_distance(grid: Grid, coordinate: f32, cell: i32, axis: u32) -> f32 {
    var below = f32(cell) - coordinate;
    var above = coordinate - f32(cell + 1);
    if (grid.wrap[axis] == 0u) {
        below = select(below, 0.0, cell == 0);
        above = select(above, 0.0, cell == i32(grid.size[axis]) - 1);
    }
    return max(max(below, above) - slack(coordinate), 0.0);
}
