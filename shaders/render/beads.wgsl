// #include numbers, colour, scene
// Balls of the particles that a view shows, with their colours.

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> pressures: array<f32>;
@group(0) @binding(4) var<storage, read_write> balls: array<vec4<f32>>;

// Colour of water of a speed, 0 (still) to 1.
fn colour_of_water(speed: f32) -> vec3<f32> {
    let slow = mix(BEADS_WATER, BEADS_FAST_WATER, smooth_between(0.0, 0.5, speed));
    return mix(slow, BEADS_FOAM, smooth_between(0.35, 1.0, speed));
}

fn is_chosen(place: vec3<f32>) -> bool {
    if (scene.view != VIEW_CUTAWAY) {
        return true;
    }
    let height = dot(place - scene.section_point, scene.section_normal) / scene.radius;
    return height < BEADS_SECTION.x && height > -BEADS_SECTION.y;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = row_of(group, groups, lane);
    if (row >= scene.particles) {
        return;
    }
    let place = positions[row].xyz;
    var speed = 0.0;
    if (scene.has_velocities != 0u) {
        speed = length(velocities[row].xyz);
    }
    var colour = vec3(0.0);
    if (scene.view == VIEW_SPEED) {
        colour = colour_map(speed / max(scene.highest, 1.0e-37));
    } else if (scene.view == VIEW_PRESSURE) {
        var pressure = 0.0;
        if (scene.has_pressures != 0u) {
            pressure = pressures[row];
        }
        colour = colour_map((pressure - scene.lowest) / max(scene.highest - scene.lowest, 1.0e-37));
    } else {
        let share = speed / scene.fastest;
        colour = colour_of_water(select(0.0, min(share, 1.0), is_finite(share)));
    }
    let is_shown = all_finite(place) && is_chosen(place);
    balls[2u * row] = select(vec4(0.0, 0.0, 0.0, -1.0), vec4(place, scene.radius), is_shown);
    balls[2u * row + 1u] = vec4(colour, 0.0);
}
