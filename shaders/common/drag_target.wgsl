// Target of a node and the mass of both, by what it does without drag (`start`), and the impulse and the mass of the drag.
fn drag_target(start: vec4<f32>, place: vec3<f32>, velocity: vec3<f32>, received: vec4<f32>) -> vec4<f32> {
    if (start[NODE_FREE_MASS] <= 0.0 || received[NODE_DRAG_MASS] <= MINIMUM_DRAG_MASS) {
        return start;
    }
    let mass = start[NODE_FREE_MASS] + received[NODE_DRAG_MASS];
    let by_fluid = place + (velocity + received.xyz / received[NODE_DRAG_MASS]) * clock.step;
    return vec4<f32>(start.xyz + (by_fluid - start.xyz) * (received[NODE_DRAG_MASS] / mass), mass);
}
