// Rows of a pressure solve: what a round does with the row of a particle.

struct PressureRow {
    pressure: f32,
    change: f32,
    diagonal: f32,
    compression: f32,
}

fn pressure_row(row: vec4<f32>) -> PressureRow {
    return PressureRow(
        row[FLUID_PRESSURE_ROWS_PRESSURE],
        row[FLUID_PRESSURE_ROWS_CHANGE],
        row[FLUID_PRESSURE_ROWS_DIAGONAL],
        row[FLUID_PRESSURE_ROWS_COMPRESSION],
    );
}

// The pressure after a step of this length along the projected gradient. `speed` is the speed of correction.
fn next_pressure(own: PressureRow, length: f32, speed: f32) -> f32 {
    let maximum = SOUND_SPEED_RATIO * speed;
    return min(max(own.pressure + length * own.compression / own.diagonal, 0.0), maximum * maximum);
}

// The row with another pressure.
fn with_pressure(own: PressureRow, next: f32) -> vec4<f32> {
    return vec4<f32>(next, next - own.pressure, own.diagonal, own.compression);
}

// What a particle with this remaining compression adds to the sums of a round: its error, s.Ms, s.y and y.(y / M).
fn round_sums(before: PressureRow, left: f32) -> vec4<f32> {
    let response = before.compression - left;
    var error = left;
    if (left <= 0.0) {
        error = min(-left, before.pressure * before.diagonal);
    }
    return vec4<f32>(
        error,
        before.change * before.change * before.diagonal,
        before.change * response,
        response * response / before.diagonal,
    );
}
