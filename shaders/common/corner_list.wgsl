// Lists of the corners that controls are of the tets of particles. First come the starts of all lists and the end of the last. Then come
// the entries, each four times the row of the particle plus the number of the corner.

// First entry and end.
fn corner_list(row: u32, is_row: bool) -> vec2<u32> {
    if (!is_row) {
        return vec2<u32>(0u);
    }
    let base = params.node_rows + 1u;
    return base + vec2<u32>(control_corners[row], control_corners[row + 1u]);
}
