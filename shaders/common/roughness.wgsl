// What of the roughness of the pressure the compression of a single step follows; `predict.rs` says why.
fn prompt_roughness() -> f32 {
    if (params.roughness == 0.0) {
        return 0.0;
    }
    let delayed = params.roughness * clock.step / (clock.step + 8.0 * sqrt(params.roughness));
    return min(params.roughness, max(delayed, 0.2 * clock.step * clock.step));
}
