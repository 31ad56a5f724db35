// Lists of the targets near points. `list[row]` is their number, `list[(k + 1) * rows + row]` the k-th. Needs `grid`, `shares`, `ball` and
// `near`. The pass binds `targets`, `list` and `extremes`. It says what its lists are, by `lists()`, and which target is at a place of
// the cells, by `target_at(place)`.

struct Lists {
    rows: u32,
    capacity: u32,
    radius: f32,
}

struct Found {
    // In the list so far, and where the last of them is.
    count: u32,
    place: u32,
}

fn begin_list(own: u32, count: u32) -> Found {
    return Found(count, own + count * lists().rows);
}

fn visit_run(before: Found, point: vec3<f32>, begin: u32, end: u32) -> Found {
    var found = before;
    let radius = lists().radius;
    for (var place = begin; place < end; place += 1u) {
        let other = target_at(place);
        let apart = point - targets[other].xyz;
        if (dot(apart, apart) < radius * radius) {
            if (found.count < lists().capacity) {
                found.place += lists().rows;
                list[found.place] = other;
            }
            found.count += 1u;
        }
    }
    return found;
}

// Makes the list of a row, from what a ball may meet. A list that does not fit is noted.
fn list_near(share: SharedRow, lane: u32, point: vec3<f32>, radius: f32, extreme: u32) {
    let capacity = lists().capacity;
    let length = find(share, lane, point, radius, capacity).count;
    if (share.is_last) {
        list[share.row] = length;
        if (length > capacity) {
            atomicMax(&extremes[extreme], length);
        }
    }
}
