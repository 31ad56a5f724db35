// What is near a point, also in periodic images of the box. Needs `grid`, `shares` and `ball`. The pass says what it has `Found` at the
// beginning: `begin_list(own, count)`, with `count` entries in the list of the row `own`. From its capacity on a list stores none.

// Whether images of the box come near a point: those before it (-1) and those behind it (1) along periodic axes.
fn touches_box(point: vec3<f32>, radius: f32, image: vec3<f32>) -> bool {
    let before = point - radius <= params.period_low;
    let behind = point + radius >= params.period_high;
    let near = select(before, behind, image > vec3<f32>(0.0)) & (params.periods > vec3<f32>(0.0));
    return all(near | (image == vec3<f32>(0.0)));
}

// The part of one of the threads that share a row.
fn visit_near(before: Found, point: vec3<f32>, radius: f32, part: u32) -> Found {
    var found = before;
    // The box itself first, then its images.
    let images = select(1u, 27u, params.has_periods != 0u);
    for (var index = 0u; index < images; index += 1u) {
        let place = vec3<f32>(vec3<u32>(index % 3u, index / 3u % 3u, index / 9u));
        let image = select(place, vec3<f32>(-1.0), place > vec3<f32>(1.0));
        if (index == 0u || touches_box(point, radius, image)) {
            found = visit_ball(found, point - image * params.periods, radius, part, SHARES);
        }
    }
    return found;
}

// Finds the entries of the list of a row, threads of the row by turns. They count first, so that each knows where its own begin. In the
// last of them the count is the length of the list.
fn find(share: SharedRow, lane: u32, point: vec3<f32>, radius: f32, capacity: u32) -> Found {
    var before = 0u;
    if (SHARES > 1u) {
        let counted = visit_near(begin_list(share.row, capacity), point, radius, share.first);
        before = share_before(lane, counted.count - capacity);
    }
    let first = select(capacity, before, share.is_row);
    return visit_near(begin_list(share.row, first), point, radius, share.first);
}
