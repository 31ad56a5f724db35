// Sums over the threads of a workgroup, always in the same order.

var<workgroup> impulses: array<vec3<f32>, GROUP_THREADS>;
var<workgroup> angular_impulses: array<vec3<f32>, GROUP_THREADS>;
var<workgroup> any_touches: atomic<u32>;

struct Wrench {
    impulse: vec3<f32>,
    angular: vec3<f32>,
}

// The same for all threads: whether one of them touches.
fn group_touches(lane: u32, touches: bool) -> bool {
    if (lane == 0u) {
        atomicStore(&any_touches, 0u);
    }
    workgroupBarrier();
    if (touches) {
        atomicStore(&any_touches, 1u);
    }
    workgroupBarrier();
    let any = atomicLoad(&any_touches);
    workgroupBarrier();
    return any != 0u;
}

// Valid in thread 0.
fn group_sum(lane: u32, own: Wrench) -> Wrench {
    impulses[lane] = own.impulse;
    angular_impulses[lane] = own.angular;
    for (var half = GROUP_THREADS / 2u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            impulses[lane] += impulses[lane + half];
            angular_impulses[lane] += angular_impulses[lane + half];
        }
    }
    workgroupBarrier();
    let sum = Wrench(impulses[0], angular_impulses[0]);
    workgroupBarrier();
    return sum;
}
