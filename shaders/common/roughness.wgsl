// What of the roughness of the pressure the compression of a single step follows; `predict.rs` says why.
fn prompt_roughness() -> f32 {
    return min(params.roughness, clock.step * sqrt(params.roughness) / 2.236);
}
