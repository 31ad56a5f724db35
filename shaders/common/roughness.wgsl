// Stabilisation coefficient of a single step; `predict.rs` has the reason.
fn prompt_roughness() -> f32 {
    if (params.roughness == 0.0) {
        return 0.0;
    }
    let delayed = params.roughness * clock.step / (clock.step + ROUGHNESS_DELAY * sqrt(params.roughness));
    return min(params.roughness, max(delayed, PROMPT_ROUGHNESS * clock.step * clock.step));
}
