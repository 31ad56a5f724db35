// #include sums, water_around
// Where rays meet the surface of the water: a group for each, whose threads take one place each.
//
// a: distance, or less than 0 if it meets none; particles near the ray; b: outward normal.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> question: Question;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> near_ray: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> answers: array<QueryAnswer>;

var<workgroup> counts: array<u32, GROUP_THREADS>;
var<workgroup> first_in: atomic<u32>;
var<workgroup> chosen: u32;

// Whether a particle, or one of its images, is within the radius of a ray. Between which distances it is itself, and its images across
// periodic sides: the last negated. Behind walls there is no water to meet.
fn near(origin: vec3<f32>, direction: vec3<f32>, length: f32, place: vec3<f32>) -> vec3<f32> {
    var found = vec3<f32>(0.0, NO_VALUE, NO_VALUE);
    for (var k = 0u; k < 27u; k += 1u) {
        let x = image_at(place, 0u, k % 3u);
        let y = image_at(place, 1u, k / 3u % 3u);
        let z = image_at(place, 2u, k / 9u);
        if (max(x, max(y, z)) >= NO_IMAGE) {
            continue;
        }
        let t = dot(vec3<f32>(x, y, z) - origin, direction);
        let on_ray = origin + clamp(t, 0.0, length) * direction;
        if (distance(vec3<f32>(x, y, z), on_ray) < question.radius) {
            found.x = 1.0;
            if (!is_mirrored(0u, k % 3u) && !is_mirrored(1u, k / 3u % 3u) && !is_mirrored(2u, k / 9u)) {
                found = vec3<f32>(1.0, max(found.yz, vec2<f32>(t, -t)));
            }
        }
    }
    return found;
}

fn filled(point: vec3<f32>, begin: u32, count: u32) -> f32 {
    var all = 0.0;
    for (var k = begin; k < begin + count; k += 1u) {
        all += shares_around(point, near_ray[k].xyz).y;
    }
    return all;
}

// The first thread that is in the water; GROUP_THREADS if none is.
fn first_of(lane: u32, is_in: bool) -> u32 {
    if (lane == 0u) {
        atomicStore(&first_in, GROUP_THREADS);
    }
    workgroupBarrier();
    if (is_in) {
        atomicMin(&first_in, lane);
    }
    workgroupBarrier();
    if (lane == 0u) {
        chosen = atomicLoad(&first_in);
    }
    return workgroupUniformLoad(&chosen);
}

// The particles near a ray.
struct Near {
    // How many there are.
    all: u32,
    // How many of them there is room for.
    count: u32,
    // Largest of the distances along the ray at which they end, and of the negative ones at which they begin.
    span: vec4<f32>,
}

// Stores the particles near a ray from the place `begin` on, thread by thread.
fn collect_near(lane: u32, begin: u32, origin: vec3<f32>, direction: vec3<f32>, length: f32) -> Near {
    var own = 0u;
    for (var row = lane; row < params.fluid_rows; row += GROUP_THREADS) {
        own += u32(near(origin, direction, length, fluid_position[row].xyz).x);
    }
    counts[lane] = own;
    workgroupBarrier();
    var before = 0u;
    var all = 0u;
    for (var k = 0u; k < GROUP_THREADS; k += 1u) {
        before += select(0u, counts[k], k < lane);
        all += counts[k];
    }
    var span = vec4<f32>(NO_VALUE);
    var slot = before;
    for (var row = lane; row < params.fluid_rows; row += GROUP_THREADS) {
        let place = fluid_position[row].xyz;
        let found = near(origin, direction, length, place);
        if (found.x > 0.0) {
            if (slot < NEAR_RAY) {
                near_ray[begin + slot] = vec4<f32>(place, 0.0);
            }
            slot += 1u;
            span = max(span, vec4<f32>(found.yz, 0.0, 0.0));
        }
    }
    storageBarrier();
    return Near(all, min(all, NEAR_RAY), group_row(lane, span, true));
}

// Distance at which a ray enters the water between two distances, -1 if it does not. Computes the share of water at places one step
// apart, then twice between the last outside and the first inside.
fn first_hit(lane: u32, begin: u32, count: u32, origin: vec3<f32>, direction: vec3<f32>, ends: vec2<f32>) -> f32 {
    var step = question.step;
    var hit = -1.0;
    var chunk = 0u;
    let chunks = u32(max(ends.y - ends.x, 0.0) / (step * f32(GROUP_THREADS))) + 1u;
    counts[0] = select(0u, chunks, count > 0u);
    let total = workgroupUniformLoad(&counts[0]);
    var found = GROUP_THREADS;
    for (chunk = 0u; chunk < total && found == GROUP_THREADS; chunk += 1u) {
        let at = min(ends.x + step * f32(chunk * GROUP_THREADS + lane), ends.y);
        found = first_of(lane, filled(origin + at * direction, begin, count) > SURFACE_SHARE);
    }
    if (found < GROUP_THREADS) {
        let ahead = (chunk - 1u) * GROUP_THREADS + found;
        hit = min(ends.x + step * f32(ahead), ends.y);
        if (ahead > 0u) {
            for (var refinement = 0u; refinement < 2u; refinement += 1u) {
                let low = hit - step;
                step = step / f32(GROUP_THREADS);
                let at = low + step * f32(lane + 1u);
                let inside = first_of(lane, filled(origin + at * direction, begin, count) > SURFACE_SHARE);
                hit = low + step * f32(min(inside, GROUP_THREADS - 1u) + 1u);
            }
        }
    }
    return hit;
}

// Slope of the share of water at a point, by six threads.
fn slope_at(lane: u32, begin: u32, count: u32, point: vec3<f32>, is_hit: bool) -> vec4<f32> {
    let axis = lane / 2u % 3u;
    var beside = vec3<f32>(0.0);
    beside[axis] = select(question.step, -question.step, lane % 2u == 0u);
    var slope = vec4<f32>(0.0);
    if (lane < 6u && is_hit) {
        let share = filled(point + beside, begin, count);
        slope[axis] = select(-share, share, lane % 2u == 0u);
    }
    return group_row(lane, slope, false);
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place_in_batch = group_of(group, groups);
    let index = min(question.first + place_in_batch, question.count - 1u);
    // A row for the origin and the length of a ray, and one for its direction.
    let first = asked[2u * index];
    let direction = asked[2u * index + 1u].xyz;
    let begin = place_in_batch * NEAR_RAY;
    let length = first[RAY_LENGTH];
    let around = collect_near(lane, begin, first.xyz, direction, length);
    let start = max(-around.span.y - question.radius, 0.0);
    let end = min(around.span.x + question.radius, length);
    let hit = first_hit(lane, begin, around.count, first.xyz, direction, vec2<f32>(start, end));
    let normal = slope_at(lane, begin, around.count, first.xyz + hit * direction, hit >= 0.0);
    if (lane == 0u && question.first + place_in_batch < question.count) {
        answers[index] = QueryAnswer(vec4<f32>(hit, f32(around.all), 0.0, 0.0), normal);
    }
}
