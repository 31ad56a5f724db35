// How long a step may be: the bounds of `clock.rs`, from what the last step found. The steps of a frame need no answer from the host.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> clock: Clock;
@group(0) @binding(2) var<storage, read_write> extremes: array<u32, EXTREME_COUNT>;

fn offer(step: f32, bound: u32) {
    if (step < clock.step) {
        clock.step = step;
        clock.bound = bound;
    }
}

fn choose_step() {
    clock.step = params.constant_step;
    clock.bound = params.constant_bound;
    let radius = params.smoothing.support_radius;
    if (params.has_moving_fluid == 1u) {
        let speed = select(params.sound_speed, 0.0, params.incompressible == 1u) + clock.fluid_speed;
        if (speed > 0.0) {
            offer(params.courant * radius / speed, BOUND_COURANT);
        }
        if (clock.fluid_pressure > 0.0) {
            offer(PRESSURE_COURANT * params.spacing / sqrt(PEAK_PRESSURE * clock.fluid_pressure), BOUND_PRESSURE);
        }
        // A solve for the divergence has no error that grows with the acceleration of a particle.
        if (clock.fluid_acceleration > 0.0 && params.divergence == 0u) {
            offer(ACCELERATION_COURANT * sqrt(radius / clock.fluid_acceleration), BOUND_ACCELERATION);
        }
    }
    if (clock.body_speed > 0.0) {
        let crossing = LATTICE_COURANT * params.edge;
        let reach = min(select(crossing, params.courant * radius, params.has_moving_fluid == 1u), crossing);
        offer(max(reach / clock.body_speed, SHORTEST_BY_BODY * params.minimum_step), BOUND_BODY_SPEED);
    }
    if (clock.node_speed > 0.0) {
        offer(LATTICE_COURANT * params.edge / clock.node_speed, BOUND_SPONGE_SPEED);
    }
    if (clock.step < params.minimum_step) {
        clock.status = STATUS_TOO_SMALL;
        clock.needed = clock.step;
        clock.running = 0u;
        return;
    }
    // Equal steps fill what is left.
    if (clock.step >= clock.left) {
        clock.step = clock.left;
        clock.bound = BOUND_FRAME;
    } else if (clock.left < 1.0e6 * clock.step) {
        clock.step = clock.left / ceil(clock.left / clock.step * (1.0 - CUT_TOLERANCE));
    }
}

fn begin_step() {
    clock.running = select(0u, 1u, clock.left > TIME_RESOLUTION);
    if (clock.running == 1u && clock.given == 0u) {
        choose_step();
    }
    clock.inverse_step = 1.0 / clock.step;
}

// Before the first step of a batch.
@compute @workgroup_size(1)
fn begin() {
    clock.status = STATUS_DONE;
    clock.rounds = 0u;
    clock.is_converged = 0u;
    clock.maximum_rounds = vec4<u32>(0u);
    for (var k = 0u; k < EXTREME_COUNT; k += 1u) {
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
    for (var k = 0u; k < LIST_COUNT; k += 1u) {
        clock.longest[k / 4u][k % 4u] = extremes[EXTREME_NEIGHBORS + k];
    }
    if (any((clock.longest[0] | clock.longest[1]) != vec4<u32>(0u))) {
        clock.status = STATUS_LIST_FULL;
        clock.running = 0u;
    }
}

// Before more rounds of a repetition that the device stopped at.
@compute @workgroup_size(1)
fn resume() {
    if (clock.status == STATUS_UNFINISHED) {
        clock.status = STATUS_DONE;
        clock.running = 1u;
    }
}

fn take_over() {
    clock.fluid_speed = sqrt(bitcast<f32>(extremes[EXTREME_FLUID_SPEED]));
    clock.fluid_acceleration = sqrt(bitcast<f32>(extremes[EXTREME_FLUID_ACCELERATION]));
    clock.node_speed = sqrt(bitcast<f32>(extremes[EXTREME_NODE_SPEED]));
    clock.fluid_pressure = bitcast<f32>(extremes[EXTREME_PRESSURE]);
    clock.maximum_speed = max(clock.maximum_speed, max(clock.fluid_speed, clock.node_speed));
    clock.last_step = clock.step;
    clock.last_bound = clock.bound;
    clock.shortest = min(clock.shortest, clock.step);
    clock.left -= clock.step;
    clock.steps += 1u;
    clock.bounds[clock.bound / 4u][clock.bound % 4u] += 1u;
}

// After the last phase of a step.
@compute @workgroup_size(1)
fn finish() {
    if (clock.running == 0u) {
        return;
    }
    take_over();
    if (extremes[EXTREME_FLUID_ROW] != 0u) {
        clock.status = STATUS_NOT_FINITE_PARTICLE;
        clock.failed_row = 0xffffffffu - extremes[EXTREME_FLUID_ROW];
    } else if (extremes[EXTREME_NODE_ROW] != 0u) {
        clock.status = STATUS_NOT_FINITE_NODE;
        clock.failed_row = 0xffffffffu - extremes[EXTREME_NODE_ROW];
    }
    for (var k = 0u; k < EXTREME_COUNT; k += 1u) {
        extremes[k] = 0u;
    }
    if (clock.status != STATUS_DONE) {
        clock.running = 0u;
        return;
    }
    begin_step();
}
