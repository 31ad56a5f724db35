// After a round of a repetition that ends when it has converged. All passes of the rounds that are left then return at once, as when the
// time is filled. `clock/rounds.wgsl` has the rest. The pass binds the clock to be written.

fn end_of_round(is_over: bool) {
    clock.rounds += 1u;
    clock.all_rounds += 1u;
    if (is_over) {
        clock.is_converged = 1u;
        clock.running = 0u;
    }
}

// One round, which the pass says how to take (`take_round(lane)`) and when it was enough (`has_converged()`). Those of the last
// pass of a round end it.
fn run_round(lane: u32, ends: bool) {
    if (clock.running == 0u) {
        return;
    }
    take_round(lane);
    workgroupBarrier();
    if (ends && lane == 0u) {
        end_of_round(has_converged());
    }
}
