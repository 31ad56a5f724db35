// Drawn lines on bodies: edges of boxes, and those of models of wire.

// Distance of a point on the surface to the nearest edge of a body (m): only cuboids have drawn edges.
fn body_edge(body: u32, point: vec3<f32>) -> f32 {
    if (body_kind(body) != SHAPE_CUBOID) {
        return FAR_AWAY;
    }
    let inside = max(body_row(body, 4u).xyz - abs(body_local(body, point)), vec3(0.0));
    // The smallest of the three belongs to the face of the point; the next one is the distance to an edge.
    return middle_of(inside);
}

fn middle_of(v: vec3<f32>) -> f32 {
    return min(min(max(v.x, v.y), max(v.x, v.z)), max(v.y, v.z));
}

// Distance of a point on the surface to the nearest line of a model of wire (m).
fn body_wire(body: u32, point: vec3<f32>) -> f32 {
    let p = body_local(body, point);
    switch (body_kind(body)) {
        case SHAPE_CUBOID: { return body_edge(body, point); }
        case SHAPE_SPHERE: { return least(abs(p)); }
        case SHAPE_CAPSULE: {
            let half_height = body_row(body, 4u).y;
            return min(min(abs(p.x), abs(p.z)), min(abs(p.y - half_height), abs(p.y + half_height)));
        }
        case SHAPE_HULL: {
            let list = body_list(body);
            var first = FAR_AWAY;
            var second = FAR_AWAY;
            for (var k = 0u; k < list.y; k++) {
                let plane = bodies[list.x + k];
                let gap = abs(plane.w - dot(plane.xyz, p));
                second = min(second, max(gap, first));
                first = min(first, gap);
            }
            return second;
        }
        default: { return FAR_AWAY; }
    }
}
