// #include numbers, scene, cells
// An anisotropic kernel for every free particle: flat along a surface, long in a jet, a ball where a drop is alone.

@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> free: array<f32>;
// Centre and mass; metric xx, xy, xz, yy; metric yz, zz; half sides of the box around it.
@group(0) @binding(4) var<storage, read_write> kernels: array<vec4<f32>>;
// Lowest and highest corner of all kernels, as numbers that grow as floats do.
@group(0) @binding(5) var<storage, read_write> bounds: array<atomic<u32>>;

var<workgroup> group_bounds: array<atomic<u32>, 6>;

struct Kernel {
    centre: vec3<f32>,
    mass: f32,
    diagonal: vec3<f32>,
    // xy, xz, yz.
    sides: vec3<f32>,
    extent: vec3<f32>,
}

struct Sums {
    total: f32,
    mean: vec3<f32>,
    diagonal: vec3<f32>,
    sides: vec3<f32>,
}

// Whether no cell within two cells of a point is empty, and all of them have enough points.
fn are_full(point: vec3<f32>) -> bool {
    let cell = cell_of(point);
    if (any(cell < vec3(2u)) || any(cell + 2u >= scene.cell_sides)) {
        return false;
    }
    var count = 0u;
    for (var z = cell.z - 2u; z <= cell.z + 2u; z++) {
        for (var y = cell.y - 2u; y <= cell.y + 2u; y++) {
            let row = cell_index(vec3(cell.x - 2u, y, z));
            for (var x = 0u; x < 5u; x++) {
                if (cells[row + x] == cells[row + x + 1u]) {
                    return false;
                }
            }
            count += cells[row + 5u] - cells[row];
        }
    }
    return f32(count) >= 0.88 * KERNELS_BLOCK;
}

// Adds what is around a point, or around its mirror image, of which `flip` has the signs.
fn gather(sums: ptr<function, Sums>, image: vec3<f32>, flip: vec3<f32>) {
    let reach = KERNELS_REACH * scene.spacing;
    let scale = 1.0 / (reach * reach);
    let cell = vec3<i32>(floor((image - scene.cell_low) / scene.cell_side));
    let last = vec3<i32>(scene.cell_sides) - 1;
    let first = max(clamp(cell, vec3(0), last) - 2, vec3(0));
    let end = min(clamp(cell, vec3(0), last) + 2, last);
    for (var z = first.z; z <= end.z; z++) {
        for (var y = first.y; y <= end.y; y++) {
            let row = (u32(z) * scene.cell_sides.y + u32(y)) * scene.cell_sides.x;
            for (var k = cells[row + u32(first.x)]; k < cells[row + u32(end.x) + 1u]; k++) {
                let r = (points[cells[scene.cell_list + k]].xyz - image) * flip;
                let share = 1.0 - dot(r, r) * scale;
                if (share > 0.0) {
                    let weight = share * share;
                    (*sums).total += weight;
                    (*sums).mean += weight * r;
                    (*sums).diagonal += weight * r * r;
                    (*sums).sides += weight * r.xxy * r.yzz;
                }
            }
        }
    }
}

// Sums over the neighbourhood, and over the mirror images of the water behind walls, but not above.
fn neighbourhood(point: vec3<f32>) -> Sums {
    var sums = Sums(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
    let reach = KERNELS_REACH * scene.spacing;
    for (var choice = 0u; choice < 27u; choice++) {
        let sides = vec3(choice % 3u, (choice / 3u) % 3u, choice / 9u);
        if (choice > 0u && scene.has_container == 0u) {
            break;
        }
        let walls = select(scene.high, scene.low, sides == vec3(1u));
        let gaps = abs(point - walls);
        let is_mirrored = sides != vec3(0u);
        if (sides.y == 2u || any(is_mirrored & (gaps >= vec3(reach)))) {
            continue;
        }
        let image = select(point, 2.0 * walls - point, is_mirrored);
        gather(&sums, image, select(vec3(1.0), vec3(-1.0), is_mirrored));
    }
    return sums;
}

fn ball(centre: vec3<f32>, radius: f32, mass: f32) -> Kernel {
    return Kernel(centre, mass, vec3(1.0 / (radius * radius)), vec3(0.0), vec3(radius));
}

fn kernel_of(point: vec3<f32>, share: f32) -> Kernel {
    let spacing = scene.spacing;
    let deep = ball(point, KERNELS_DEEP * spacing, share * KERNELS_NORM * KERNELS_PACKED / (KERNELS_DEEP * KERNELS_DEEP * KERNELS_DEEP));
    if (are_full(point)) {
        return deep;
    }
    let reach = KERNELS_REACH * spacing;
    let sums = neighbourhood(point);
    let inverse = 1.0 / max(sums.total, 1.0e-6);
    let mean = sums.mean * inverse;
    let diagonal = sums.diagonal * inverse - mean * mean;
    let sides = sums.sides * inverse - mean.xxy * mean.yzz;
    let full = KERNELS_FULL * KERNELS_REACH * KERNELS_REACH * KERNELS_REACH;
    let company = smooth_between(0.0, 1.0, (sums.total - 1.0) / (0.35 * (full - 1.0)));
    // Deep in the bulk only the sign matters: a narrow kernel that leaves no gaps. It gets narrow little by little.
    let depth = smooth_between(KERNELS_BULK.x, KERNELS_BULK.y, sums.total / full)
        * (1.0 - smooth_between(KERNELS_EVEN.x, KERNELS_EVEN.y, length(mean) / reach));
    if (depth >= 1.0) {
        return deep;
    }
    let wide = KERNELS_ALONE + (KERNELS_RADIUS - KERNELS_ALONE) * company;
    let narrow = wide + (KERNELS_DEEP - wide) * depth;
    let crowd = 1.0 + (KERNELS_PACKED - 1.0) * (depth * depth) * (depth * depth);
    let radius = narrow * spacing;
    let mass = share * KERNELS_NORM * crowd / (narrow * narrow * narrow);
    let centre = point + mean * (KERNELS_SHIFT * company);
    let trace = (diagonal.x + diagonal.y + diagonal.z) / 3.0;
    // In squared spacings, or the determinant would be too small for floats.
    let scale = 1.0 / (spacing * spacing);
    let d = (diagonal + KERNELS_ROUNDING * trace) * scale + (1.0 - company);
    let s = sides * scale;
    // The square of the covariance takes the place of a squared length, scaled to the volume of a ball.
    let dd = d * d + vec3(s.x * s.x + s.y * s.y, s.x * s.x + s.z * s.z, s.y * s.y + s.z * s.z);
    let ss = vec3(
        s.x * (d.x + d.y) + s.y * s.z,
        s.y * (d.x + d.z) + s.x * s.z,
        s.z * (d.y + d.z) + s.x * s.y,
    );
    let minors = dd.yxx * dd.zzy - ss.zyx * ss.zyx;
    let crossed = vec3(ss.y * ss.z - ss.x * dd.z, ss.x * ss.z - ss.y * dd.y, ss.x * ss.y - ss.z * dd.x);
    let volume = dd.x * minors.x + ss.x * crossed.x + ss.y * crossed.y;
    if (!(volume > 0.0 && is_finite(volume))) {
        return ball(centre, radius, mass);
    }
    let size = radius * radius / pow(volume, 1.0 / 3.0);
    let factor = 1.0 / (volume * size);
    return Kernel(centre, mass, minors * factor, crossed * factor, sqrt(dd * size));
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    if (lane < 6u) {
        atomicStore(&group_bounds[lane], select(0u, 0xffffffffu, lane < 3u));
    }
    workgroupBarrier();
    let row = row_of(group, groups, lane);
    if (row < scene.particles) {
        let share = free[row];
        if (share > 0.0) {
            let point = points[row].xyz;
            let kernel = kernel_of(point, share);
            kernels[4u * row] = vec4(kernel.centre, kernel.mass);
            kernels[4u * row + 1u] = vec4(kernel.diagonal.x, kernel.sides.xy, kernel.diagonal.y);
            kernels[4u * row + 2u] = vec4(kernel.sides.z, kernel.diagonal.z, 0.0, 0.0);
            kernels[4u * row + 3u] = vec4(kernel.extent, 0.0);
            for (var axis = 0u; axis < 3u; axis++) {
                let reach = KERNELS_REACH * scene.spacing;
                var low = kernel.centre[axis] - kernel.extent[axis];
                var high = kernel.centre[axis] + kernel.extent[axis];
                let image_low = 2.0 * scene.low[axis] - high;
                let image_high = 2.0 * scene.high[axis] - low;
                if (scene.has_container != 0u && point[axis] - scene.low[axis] < reach) {
                    low = min(low, image_low);
                }
                if (scene.has_container != 0u && axis != 1u && scene.high[axis] - point[axis] < reach) {
                    high = max(high, image_high);
                }
                atomicMin(&group_bounds[axis], ordered(low));
                atomicMax(&group_bounds[axis + 3u], ordered(high));
            }
        }
    }
    workgroupBarrier();
    if (lane < 3u) {
        atomicMin(&bounds[6u + lane], atomicLoad(&group_bounds[lane]));
    } else if (lane < 6u) {
        atomicMax(&bounds[6u + lane], atomicLoad(&group_bounds[lane]));
    }
}
