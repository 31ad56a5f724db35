// Numbers that several passes need: steps, pseudo-random numbers, and what stands for infinity.

// Smooth step from 0 at `low` to 1 at `high`.
fn smooth_between(low: f32, high: f32, value: f32) -> f32 {
    let t = clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// A pseudo-random number in 0..1 from a key.
fn unit(key: u32) -> f32 {
    var x = (key * 0x9E3779B1u) ^ 0x85EBCA6Bu;
    x = (x ^ (x >> 16u)) * 0x7FEB352Du;
    x = (x ^ (x >> 15u)) * 0x846CA68Bu;
    x ^= x >> 16u;
    return f32(x >> 8u) / 16777216.0;
}

// By its bits: compilers may assume that no number is infinite or not a number.
fn is_finite(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) != 0x7f800000u;
}

fn all_finite(value: vec3<f32>) -> bool {
    return is_finite(value.x) && is_finite(value.y) && is_finite(value.z);
}

// Whether a distance is one; `FAR_AWAY` stands for infinity.
fn is_near(distance: f32) -> bool {
    return distance < 0.5 * FAR_AWAY;
}

fn least(v: vec3<f32>) -> f32 {
    return min(min(v.x, v.y), v.z);
}

fn most(v: vec3<f32>) -> f32 {
    return max(max(v.x, v.y), v.z);
}

// Unit vector, or another one where a vector has no length.
fn unit_or(v: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let square = dot(v, v);
    return select(other, v * inverseSqrt(max(square, 1.0e-37)), square > 1.0e-36);
}

// Numbers that grow as floats do.
fn ordered(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

// A sum of the fixed point that atomics have.
fn fixed(value: f32) -> u32 {
    return u32(value * FIXED_POINT + 0.5);
}

fn of_fixed(sum: u32) -> f32 {
    return f32(sum) / FIXED_POINT;
}

// The row of a thread; groups beyond the limit of one dimension continue in the second.
fn row_of(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * GROUP + lane;
}
