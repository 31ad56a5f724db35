// After a round of a repetition that ends when it has converged: then all passes of the rounds that are left leave at once, as they
// do when the time is filled. `clock/rounds.wgsl` has the rest. The pass binds the clock to be written.

fn end_of_round(has_converged: bool) {
    clock.rounds += 1u;
    clock.all_rounds += 1u;
    if (has_converged) {
        clock.is_converged = 1u;
        clock.running = 0u;
    }
}
