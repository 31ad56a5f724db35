// Repetitions that end when they have converged, which the host need not know before it submits what comes after.
//
// The last pass of the round takes `running` away once another round is not needed (`common/end_of_round.wgsl`). `end_rounds` gives
// it back. If the submitted rounds do not suffice, the device stops there. Nothing after them is done, and the
// host submits further ones, with all that comes after them.

@group(0) @binding(0) var<uniform> repetition: Repetition;
@group(0) @binding(1) var<storage, read_write> clock: Clock;

fn note_rounds() {
    let place = repetition.index - 1u;
    clock.maximum_rounds[place] = max(clock.maximum_rounds[place], clock.rounds);
}

@compute @workgroup_size(1)
fn end_rounds() {
    if (clock.is_converged == 1u) {
        clock.is_converged = 0u;
        clock.running = 1u;
    } else if (clock.running == 0u) {
        return;
    } else if (clock.rounds < repetition.maximum) {
        clock.status = STATUS_UNFINISHED;
        clock.unfinished = repetition.index;
        clock.running = 0u;
        return;
    }
    note_rounds();
    clock.rounds = 0u;
}
