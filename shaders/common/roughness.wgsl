// What of the roughness of the pressure the compression of a single step follows; `predict.rs` says why.
fn prompt_roughness() -> f32 {
    return min(params.roughness, 0.2 * clock.step * clock.step);
}
