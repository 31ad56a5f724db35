// #include grid, sponges, star, meeting
// For every surface node, those that it may touch in this step, in the order of their rows; the list has the layout of
// `fluid_neighbors.wgsl`, and `pairs.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> normal: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> rest: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> stars: array<u32>;
@group(0) @binding(7) var<storage, read> starts: array<u32>;
@group(0) @binding(8) var<storage, read> grouped: array<u32>;
@group(0) @binding(9) var<storage, read_write> list: array<u32>;
@group(0) @binding(10) var<storage, read_write> extremes: array<atomic<u32>>;

const DEEP: f32 = 1.0;
const NEAR: f32 = 0.6;
const APART: f32 = 4.0;

fn may_touch(a: u32, b: u32, own: u32) -> bool {
    let normal_b = normal[b];
    let other = stars[b * STAR + SPONGE];
    if (normal_b.w <= 0.0 || !may_meet(own, other)) {
        return false;
    }
    let edge = max(contact_edge(own), contact_edge(other));
    if (own == other) {
        let apart = rest[a].xyz - rest[b].xyz;
        if (dot(apart, apart) < APART * APART * edge * edge) {
            return false;
        }
    }
    let pair = pair_of(position[a].xyz, position[b].xyz, normal[a].xyz, normal_b.xyz);
    let reach = REACH * edge;
    return pair.facing > 0.0 && pair.gap > -DEEP * edge && pair.gap < NEAR * edge && pair.aside < reach * reach;
}

// Puts a row into a list that is in order and has `found` entries.
fn insert(row: u32, found: u32, other: u32) {
    var place = found;
    while (place > 0u && list[place * grid.wrap.w + row] > other) {
        list[(place + 1u) * grid.wrap.w + row] = list[place * grid.wrap.w + row];
        place -= 1u;
    }
    list[(place + 1u) * grid.wrap.w + row] = other;
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= grid.wrap.w) {
        return;
    }
    if (normal[row].w <= 0.0) {
        list[row] = 0u;
        return;
    }
    let x = position[row].xyz;
    let own = stars[row * STAR + SPONGE];
    // Cells are half of the radius wide.
    let reach = 2.0;
    let at = vec3<f32>(
        coordinate_of(grid, x.x, 0u),
        coordinate_of(grid, x.y, 1u),
        coordinate_of(grid, x.z, 2u),
    );
    let span_x = cells_around(grid, at.x, reach + slack(at.x), 0u);
    let span_y = cells_around(grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(grid, at.z, reach + slack(at.z), 2u);
    let capacity = arrayLength(&list) / grid.wrap.w - 1u;
    var found = 0u;
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        for (var y = span_y.x; y <= span_y.y; y += 1) {
            let line = (wrapped(grid, z, 2u) * grid.size.y + wrapped(grid, y, 1u)) * grid.size.x;
            for (var cell = span_x.x; cell <= span_x.y; cell += 1) {
                let first = line + wrapped(grid, cell, 0u);
                for (var slot = starts[first]; slot < starts[first + 1u]; slot += 1u) {
                    let other = grouped[slot];
                    if (may_touch(row, other, own)) {
                        if (found < capacity) {
                            insert(row, found, other);
                        }
                        found += 1u;
                    }
                }
            }
        }
    }
    list[row] = found;
    if (found > capacity) {
        atomicMax(&extremes[9], found);
    }
}
