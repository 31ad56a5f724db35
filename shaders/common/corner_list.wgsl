// The list of the corners that a control is of the tets of particles: first the starts of all lists and the end of the last, then the
// entries, each four times the row of the particle and the number of the corner.

// First entry and end.
fn corner_list(row: u32, is_row: bool) -> vec2<u32> {
    if (!is_row) {
        return vec2<u32>(0u);
    }
    let base = params.node_rows + 1u;
    return base + vec2<u32>(control_corners[row], control_corners[row + 1u]);
}
