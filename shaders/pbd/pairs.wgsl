// #include grid, sponges, meeting
// For every surface node, those that it may touch in this step, in the order of their rows. The list has the layout of
// `fluid_neighbors.wgsl`, and `pairs.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<uniform> pair_grid: Grid;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_normal: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_rest: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_stars: array<u32>;
@group(0) @binding(7) var<storage, read> pair_starts: array<u32>;
@group(0) @binding(8) var<storage, read> pair_grouped: array<u32>;
@group(0) @binding(9) var<storage, read_write> node_pairs: array<u32>;
@group(0) @binding(10) var<storage, read_write> extremes: array<atomic<u32>>;

fn may_touch(a: u32, b: u32, own: u32) -> bool {
    let normal_b = node_normal[b];
    let other = node_stars[b * STAR_WORDS + STAR_SPONGE];
    if (normal_b[NODE_NORMAL_AREA] <= 0.0 || !may_meet(own, other)) {
        return false;
    }
    let edge = max(contact_edge(own), contact_edge(other));
    if (own == other) {
        let apart = node_rest[a].xyz - node_rest[b].xyz;
        if (dot(apart, apart) < SELF_CONTACT_DISTANCE * SELF_CONTACT_DISTANCE * edge * edge) {
            return false;
        }
    }
    let pair = pair_of(node_position[a].xyz, node_position[b].xyz, node_normal[a].xyz, normal_b.xyz);
    let reach = PAIR_REACH * edge;
    return pair.facing > 0.0 && pair.gap > -PAIR_OVERLAP * edge && pair.gap < PAIR_GAP * edge && pair.aside < reach * reach;
}

// Inserts a row into an ordered list of `found` entries.
fn insert(row: u32, found: u32, other: u32) {
    var place = found;
    while (place > 0u && node_pairs[place * pair_grid.rows + row] > other) {
        node_pairs[(place + 1u) * pair_grid.rows + row] = node_pairs[place * pair_grid.rows + row];
        place -= 1u;
    }
    node_pairs[(place + 1u) * pair_grid.rows + row] = other;
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= pair_grid.rows) {
        return;
    }
    if (node_normal[row][NODE_NORMAL_AREA] <= 0.0) {
        node_pairs[row] = 0u;
        return;
    }
    let x = node_position[row].xyz;
    let own = node_stars[row * STAR_WORDS + STAR_SPONGE];
    // Cells are half of the radius wide.
    let reach = 2.0;
    let at = vec3<f32>(
        coordinate_of(pair_grid, x.x, 0u),
        coordinate_of(pair_grid, x.y, 1u),
        coordinate_of(pair_grid, x.z, 2u),
    );
    let span_x = cells_around(pair_grid, at.x, reach + slack(at.x), 0u);
    let span_y = cells_around(pair_grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(pair_grid, at.z, reach + slack(at.z), 2u);
    let capacity = arrayLength(&node_pairs) / pair_grid.rows - 1u;
    var found = 0u;
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        for (var y = span_y.x; y <= span_y.y; y += 1) {
            let line = (wrapped(pair_grid, z, 2u) * pair_grid.size.y + wrapped(pair_grid, y, 1u)) * pair_grid.size.x;
            for (var cell = span_x.x; cell <= span_x.y; cell += 1) {
                let first = line + wrapped(pair_grid, cell, 0u);
                for (var slot = pair_starts[first]; slot < pair_starts[first + 1u]; slot += 1u) {
                    let other = pair_grouped[slot];
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
    node_pairs[row] = found;
    if (found > capacity) {
        atomicMax(&extremes[EXTREME_PAIRS], found);
    }
}
