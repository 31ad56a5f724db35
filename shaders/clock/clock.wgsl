// How long a step may be, on the device, so that the steps of a frame need no answer from the host: the bounds of
// `clock.rs`, from what the last step found.
//
// `extremes`: squared speed and acceleration of particles, squared speed of nodes (bits of f32); rows that are not
// finite, of particles and nodes (0xffffffff - row, 0 if there is none); longest lists that did not fit, as in
// `Clock`; root of the mean square of the pressure (bits of f32); the longest of the fourth kind.

const NOT_FINITE_PARTICLE: u32 = 1u;
const NOT_FINITE_NODE: u32 = 2u;
const TOO_SMALL: u32 = 3u;
const LIST_FULL: u32 = 4u;
const UNFINISHED: u32 = 5u;

const FRAME: u32 = 1u;
const COURANT: u32 = 2u;
const ACCELERATION: u32 = 3u;
const SPONGE_SPEED: u32 = 8u;
const PRESSURE: u32 = 9u;
const BODY_SPEED: u32 = 10u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> clock: Clock;
@group(0) @binding(2) var<storage, read_write> extremes: array<u32, 12>;

fn offer(step: f32, bound: u32) {
    if (step < clock.step) {
        clock.step = step;
        clock.bound = bound;
    }
}

fn choose_step() {
    clock.step = params.constant_step;
    clock.bound = params.constant_bound;
    let radius = params.smoothing.radius;
    if (params.has_moving_fluid == 1u) {
        let speed = select(params.sound_speed, 0.0, params.incompressible == 1u) + clock.fluid_speed;
        if (speed > 0.0) {
            offer(params.courant * radius / speed, COURANT);
        }
        if (clock.fluid_pressure > 0.0) {
            offer(params.pressure_courant * params.spacing / sqrt(sqrt(3.0) * clock.fluid_pressure), PRESSURE);
        }
        if (clock.fluid_acceleration > 0.0) {
            offer(0.25 * sqrt(radius / clock.fluid_acceleration), ACCELERATION);
        }
    }
    if (clock.body_speed > 0.0) {
        // No shorter than ten of the shortest: what is faster is swept.
        let reach = min(select(0.25 * params.edge, params.courant * radius, params.has_moving_fluid == 1u), 0.25 * params.edge);
        offer(max(reach / clock.body_speed, 10.0 * params.minimum_step), BODY_SPEED);
    }
    if (clock.node_speed > 0.0) {
        offer(0.25 * params.edge / clock.node_speed, SPONGE_SPEED);
    }
    if (clock.step < params.minimum_step) {
        clock.status = TOO_SMALL;
        clock.needed = clock.step;
        clock.running = 0u;
        return;
    }
    // Equal steps fill what is left.
    if (clock.step >= clock.left) {
        clock.step = clock.left;
        clock.bound = FRAME;
    } else if (clock.left < 1.0e6 * clock.step) {
        clock.step = clock.left / ceil(clock.left / clock.step * (1.0 - 1.0e-4));
    }
}

fn begin_step() {
    clock.running = select(0u, 1u, clock.left > 1.0e-9);
    if (clock.running == 1u && clock.given == 0u) {
        choose_step();
    }
    clock.inverse_step = 1.0 / clock.step;
}

// Before the first step of a batch.
@compute @workgroup_size(1)
fn begin() {
    clock.status = 0u;
    clock.rounds = 0u;
    clock.is_converged = 0u;
    clock.most_rounds = vec4<u32>(0u);
    for (var k = 0u; k < 12u; k += 1u) {
        extremes[k] = 0u;
    }
    begin_step();
}

// After the searches, and before anything that survives the step is written: a list that is full stops everything, and
// the host makes it longer.
@compute @workgroup_size(1)
fn check() {
    if (clock.running == 0u) {
        return;
    }
    clock.longest_0 = extremes[5];
    clock.longest_1 = extremes[6];
    clock.longest_2 = extremes[7];
    clock.longest_3 = extremes[9];
    if ((clock.longest_0 | clock.longest_1 | clock.longest_2 | clock.longest_3) != 0u) {
        clock.status = LIST_FULL;
        clock.running = 0u;
    }
}

// Before more rounds of a repetition that the device stopped at.
@compute @workgroup_size(1)
fn resume() {
    if (clock.status == UNFINISHED) {
        clock.status = 0u;
        clock.running = 1u;
    }
}

fn take_over() {
    clock.fluid_speed = sqrt(bitcast<f32>(extremes[0]));
    clock.fluid_acceleration = sqrt(bitcast<f32>(extremes[1]));
    clock.node_speed = sqrt(bitcast<f32>(extremes[2]));
    clock.fluid_pressure = bitcast<f32>(extremes[8]);
    clock.maximum_speed = max(clock.maximum_speed, max(clock.fluid_speed, clock.node_speed));
    clock.last_step = clock.step;
    clock.last_bound = clock.bound;
    clock.shortest = min(clock.shortest, clock.step);
    clock.left -= clock.step;
    clock.steps += 1u;
    if (clock.bound < 4u) {
        clock.bounds_0[clock.bound] += 1u;
    } else if (clock.bound < 8u) {
        clock.bounds_1[clock.bound - 4u] += 1u;
    } else {
        clock.bounds_2[clock.bound - 8u] += 1u;
    }
}

// After the last phase of a step.
@compute @workgroup_size(1)
fn finish() {
    if (clock.running == 0u) {
        return;
    }
    take_over();
    if (extremes[3] != 0u) {
        clock.status = NOT_FINITE_PARTICLE;
        clock.failed_row = 0xffffffffu - extremes[3];
    } else if (extremes[4] != 0u) {
        clock.status = NOT_FINITE_NODE;
        clock.failed_row = 0xffffffffu - extremes[4];
    }
    for (var k = 0u; k < 12u; k += 1u) {
        extremes[k] = 0u;
    }
    if (clock.status != 0u) {
        clock.running = 0u;
        return;
    }
    begin_step();
}
