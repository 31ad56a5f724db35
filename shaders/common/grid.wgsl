// Cells over points: a dense grid, or a torus where the points may lie anywhere.
//
// On an axis that wraps, cells repeat: distant points may share one, and the distance test separates them. On the others,
// points outside are in the outermost cell.

// Distances in cells that rounding may hide: of the point, and of what it is compared with.
fn slack(coordinate: f32) -> f32 {
    return 0.002 + abs(coordinate) * 4.0e-7;
}

fn coordinate_of(over: Grid, value: f32, axis: u32) -> f32 {
    return (value - over.origin[axis]) * over.inverse_edge;
}

// A cell by its coordinate; not yet wrapped, but clamped to the grid where it does not wrap.
fn whole_cell(over: Grid, coordinate: f32, axis: u32) -> i32 {
    let cell = i32(clamp(floor(coordinate), -1.0e9, 1.0e9));
    if (over.wrap[axis] != 0u) {
        return cell;
    }
    return clamp(cell, 0, i32(over.size[axis]) - 1);
}

fn wrapped(over: Grid, cell: i32, axis: u32) -> u32 {
    if (over.wrap[axis] != 0u) {
        return bitcast<u32>(cell) & (over.size[axis] - 1u);
    }
    return bitcast<u32>(cell);
}

// Index of the cell of a point.
fn cell_of(over: Grid, point: vec3<f32>) -> u32 {
    let x = wrapped(over, whole_cell(over, coordinate_of(over, point.x, 0u), 0u), 0u);
    let y = wrapped(over, whole_cell(over, coordinate_of(over, point.y, 1u), 1u), 1u);
    let z = wrapped(over, whole_cell(over, coordinate_of(over, point.z, 2u), 2u), 2u);
    return (z * over.size.y + y) * over.size.x + x;
}

// First and last cell of an axis that a ball may intersect.
fn cells_around(over: Grid, coordinate: f32, reach: f32, axis: u32) -> vec2<i32> {
    let low = whole_cell(over, coordinate - reach, axis);
    let high = whole_cell(over, coordinate + reach, axis);
    // No cell twice, where a ball is wider than the torus.
    return vec2<i32>(low, min(high, low + i32(over.size[axis]) - 1));
}

// Distance in cells of a coordinate from a slab of cells.
fn slab_distance(over: Grid, coordinate: f32, cell: i32, axis: u32) -> f32 {
    var below = f32(cell) - coordinate;
    var above = coordinate - f32(cell + 1);
    if (over.wrap[axis] == 0u) {
        below = select(below, 0.0, cell == 0);
        above = select(above, 0.0, cell == i32(over.size[axis]) - 1);
    }
    return max(max(below, above) - slack(coordinate), 0.0);
}
