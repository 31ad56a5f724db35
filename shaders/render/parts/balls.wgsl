// Balls of the views that show particles or nodes, in the cells of a grid.

// First place of every cell in the list and the end of the last one, then the list. A ball stands in every cell that it reaches into.
@group(0) @binding(1) var<storage, read> cells: array<u32>;
// Place and radius of a ball, then its colour.
@group(0) @binding(2) var<storage, read> balls: array<vec4<f32>>;

fn ball_colour(ball: u32) -> vec3<f32> {
    return balls[2u * ball + 1u].xyz;
}

fn ball_meets(ball: u32, origin: vec3<f32>, direction: vec3<f32>, nearest: Matter) -> Matter {
    let place = balls[2u * ball];
    let offset = origin - place.xyz;
    let middle = -dot(offset, direction);
    let across = offset + direction * middle;
    let square = place.w * place.w - dot(across, across);
    if (square <= 0.0) {
        return nearest;
    }
    let t = middle - sqrt(square);
    // Of balls at the same distance the first, whatever the order of the list.
    let is_first = t == nearest.distance && nearest.kind == MATTER_BEAD && ball < nearest.number;
    if (t > SETTING_NEAR && (t < nearest.distance || is_first)) {
        return Matter(MATTER_BEAD, t, ball, (offset + direction * t) / place.w);
    }
    return nearest;
}

// The nearest ball on a ray, or what is nearer.
fn ball_on(origin: vec3<f32>, direction: vec3<f32>, nearest: Matter) -> Matter {
    var best = nearest;
    if (scene.has_balls == 0u) {
        return best;
    }
    let sides = vec3<f32>(scene.cell_sides);
    let passage = boxed(scene.cell_low, scene.cell_low + sides * scene.cell_side, origin, direction);
    if (!passage.hits || passage.enter >= best.distance) {
        return best;
    }
    let inverse = inverse_of(direction);
    let begin = max(passage.enter, 0.0);
    let place = (origin + direction * begin - scene.cell_low) / scene.cell_side;
    var cell = vec3<i32>(clamp(floor(place), vec3(0.0), sides - 1.0));
    let step = select(vec3(-1), vec3(1), inverse > vec3(0.0));
    let pace = abs(inverse) * scene.cell_side;
    let border = vec3<f32>(cell) + select(vec3(0.0), vec3(1.0), inverse > vec3(0.0));
    var exit = (scene.cell_low + border * scene.cell_side - origin) * inverse;
    loop {
        let at = (u32(cell.z) * scene.cell_sides.y + u32(cell.y)) * scene.cell_sides.x + u32(cell.x);
        for (var k = cells[at]; k < cells[at + 1u]; k++) {
            best = ball_meets(cells[scene.cell_list + k], origin, direction, best);
        }
        let out = least(exit);
        if (out > best.distance) {
            break;
        }
        if (exit.x == out) {
            cell.x += step.x;
            exit.x += pace.x;
        } else if (exit.y == out) {
            cell.y += step.y;
            exit.y += pace.y;
        } else {
            cell.z += step.z;
            exit.z += pace.z;
        }
        if (any(cell < vec3(0)) || any(cell >= vec3<i32>(scene.cell_sides))) {
            break;
        }
    }
    return best;
}
