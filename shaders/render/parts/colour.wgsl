// Colours are linear light until they are displayed.

// Linear light as a display shows it, each channel 0 to 1. Highlights are compressed as by a film (the fit of ACES by Narkowicz), then
// encoded as sRGB.
fn displayed(light: vec3<f32>) -> vec3<f32> {
    let x = 0.70 * clamp(light, vec3(0.0), vec3(COLOUR_BRIGHTEST));
    let y = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), vec3(0.0), vec3(1.0));
    return select(1.055 * pow(max(y, vec3(1.0e-9)), vec3(1.0 / 2.4)) - 0.055, 12.92 * y, y <= vec3(0.0031308));
}

// Colour of a map in linear light; places outside of 0 to 1 are at its ends.
fn colour_map(place: f32) -> vec3<f32> {
    var map = COLOUR_MAP;
    let at = select(0.0, clamp(place, 0.0, 1.0), is_finite(place)) * 8.0;
    let first = min(u32(at), 7u);
    let v = mix(map[first], map[first + 1u], at - f32(first));
    return select(pow((v + 0.055) / 1.055, vec3(2.4)), v / 12.92, v <= vec3(0.04045));
}
