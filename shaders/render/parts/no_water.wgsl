// For views without the surface of the water.

fn is_wet(point: vec3<f32>) -> bool {
    return false;
}

fn water_on(origin: vec3<f32>, direction: vec3<f32>, wet: bool, passage: Passage, event: Event) -> Event {
    return event;
}
