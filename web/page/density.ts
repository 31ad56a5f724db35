// The density of the water on a grid.

import type { SurfaceRequest } from "./messages";
import type { Vector } from "./module";

/** Cells over the spacing. */
const CELL = 0.5;
/** Most nodes of a grid: larger scenes have larger cells. */
const MOST_NODES = 600_000;
/** Radius in which particles are neighbours, over the spacing. */
const REACH = 2.2;
/** Radius of the kernel of a particle alone, and in water, over the spacing. */
const RADIUS = [1.05, 2.0] as const;
/** Share that a sponge holds of free and of held particles. */
const FREE = [0.5, 0.85] as const;
/** How far a particle is moved towards the mean of its neighbours. */
const PULL = 0.9;

export interface Field {
  size: [number, number, number];
  /** Place of the first node (m). */
  origin: Vector;
  /** Edges of a cell (m). */
  cell: Vector;
  /** Density over that of water less a half; less than 0 outside of the container. */
  values: Float32Array;
  /** The same without an end at the walls, for slopes. */
  smooth: Float32Array;
}

const smoothstep = (low: number, high: number, x: number): number => {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
};

/** Particles that count: x, y, z and the share that is free. */
type Rows = { at: Float32Array; count: number };

export function density(request: SurfaceRequest): Field | null {
  const { spacing, container } = request;
  const rows = withImages(request);
  if (rows.count === 0) return null;
  const moved = towardsNeighbours(rows, spacing);
  const field = grid(rows, spacing, container);
  const held = new Float32Array(field.smooth.length);
  splat(moved, spacing, field, held);
  const { smooth, values } = field;
  for (let at = 0; at < smooth.length; at++) {
    // Water in a sponge counts beside free water alone: no gap of air along the skin, and no skin of water on a soaked sponge.
    const free = smooth[at]!;
    smooth[at] = free + Math.min(held[at]!, free) - 0.5;
  }
  values.set(smooth);
  if (container) cutAtWalls(field, container);
  return field;
}

/** The particles and their mirror images behind the walls that are near; the lid has none. */
function withImages(request: SurfaceRequest): Rows {
  const { particles, spacing, container } = request;
  let count = particles.length / 4;
  let at = new Float32Array(particles.length * 2 + 64);
  at.set(particles);
  for (let row = 0; row < count; row++) at[4 * row + 3] = 1 - smoothstep(FREE[0], FREE[1], at[4 * row + 3]!);
  const reach = REACH * spacing;
  for (let axis = 0; container && axis < 3; axis++) {
    for (let side = 0; side < (axis === 1 ? 1 : 2); side++) {
      const wall = container[side]![axis]!;
      const own = count;
      for (let row = 0; row < own; row++) {
        const distance = Math.abs(at[4 * row + axis]! - wall);
        if (distance > reach) continue;
        if (4 * (count + 1) > at.length) {
          const grown = new Float32Array(2 * at.length);
          grown.set(at);
          at = grown;
        }
        at.copyWithin(4 * count, 4 * row, 4 * row + 4);
        at[4 * count + axis] = 2 * wall - at[4 * row + axis]!;
        count++;
      }
    }
  }
  return { at, count };
}

/** Lists of rows by cubes of an edge. */
class Cubes {
  readonly starts: Int32Array;
  readonly list: Int32Array;
  readonly size: Vector;
  private readonly low: Vector;

  constructor(
    rows: Rows,
    private readonly edge: number,
  ) {
    const [low, high] = bounds(rows);
    this.low = low;
    this.size = [0, 1, 2].map((axis) => Math.max(Math.floor((high[axis]! - low[axis]!) / edge) + 1, 1)) as Vector;
    const count = this.size[0] * this.size[1] * this.size[2];
    this.starts = new Int32Array(count + 1);
    this.list = new Int32Array(rows.count);
    const cubes = new Int32Array(rows.count);
    for (let row = 0; row < rows.count; row++) {
      const [i, j, k] = [0, 1, 2].map((axis) => this.number(axis, rows.at[4 * row + axis]!)) as Vector;
      const cube = i + this.size[0] * (j + this.size[1] * k);
      cubes[row] = cube;
      this.starts[cube + 1]!++;
    }
    for (let cube = 0; cube < count; cube++) this.starts[cube + 1]! += this.starts[cube]!;
    const next = this.starts.slice();
    for (let row = 0; row < rows.count; row++) this.list[next[cubes[row]!]!++] = row;
  }

  number(axis: number, x: number): number {
    return Math.min(Math.max(Math.floor((x - this.low[axis]!) / this.edge), 0), this.size[axis]! - 1);
  }
}

function bounds(rows: Rows): [Vector, Vector] {
  const low: Vector = [Infinity, Infinity, Infinity];
  const high: Vector = [-Infinity, -Infinity, -Infinity];
  for (let row = 0; row < rows.count; row++) {
    for (let axis = 0; axis < 3; axis++) {
      const x = rows.at[4 * row + axis]!;
      low[axis] = Math.min(low[axis]!, x);
      high[axis] = Math.max(high[axis]!, x);
    }
  }
  return [low, high];
}

/** Places towards the means of the neighbours, and the radius of the kernel: x, y, z, free share, radius. */
function towardsNeighbours(rows: Rows, spacing: number): Float32Array {
  const { at, count } = rows;
  const reach = REACH * spacing;
  const cubes = new Cubes(rows, reach);
  const out = new Float32Array(5 * count);
  // Sum of the weights in a lattice, without the particle itself: 32 pi / 105 of the cube of the reach.
  const full = 0.957 * REACH ** 3 - 1;
  for (let row = 0; row < count; row++) {
    const [x, y, z] = [at[4 * row]!, at[4 * row + 1]!, at[4 * row + 2]!];
    let [sum, mx, my, mz] = [0, 0, 0, 0];
    const [ci, cj, ck] = [cubes.number(0, x), cubes.number(1, y), cubes.number(2, z)];
    for (let k = Math.max(ck - 1, 0); k <= Math.min(ck + 1, cubes.size[2] - 1); k++) {
      for (let j = Math.max(cj - 1, 0); j <= Math.min(cj + 1, cubes.size[1] - 1); j++) {
        const base = cubes.size[0] * (j + cubes.size[1] * k);
        const [first, last] = [base + Math.max(ci - 1, 0), base + Math.min(ci + 1, cubes.size[0] - 1)];
        for (let index = cubes.starts[first]!; index < cubes.starts[last + 1]!; index++) {
          const other = 4 * cubes.list[index]!;
          const [dx, dy, dz] = [at[other]! - x, at[other + 1]! - y, at[other + 2]! - z];
          const q = (dx * dx + dy * dy + dz * dz) / (reach * reach);
          if (q >= 1) continue;
          const weight = (1 - q) * (1 - q);
          sum += weight;
          mx += weight * dx;
          my += weight * dy;
          mz += weight * dz;
        }
      }
    }
    // 0 alone, 1 with half of a neighbourhood.
    const share = smoothstep(0, 1, (sum - 1) / (0.3 * full));
    const pull = (PULL * share) / sum;
    const radius = spacing * (RADIUS[0] + (RADIUS[1] - RADIUS[0]) * share);
    out.set([x + pull * mx, y + pull * my, z + pull * mz, at[4 * row + 3]!, radius], 5 * row);
  }
  return out;
}

/** A grid around the water whose nodes lie on the walls of the container. */
function grid(rows: Rows, spacing: number, container: [Vector, Vector] | null): Field {
  const [low, high] = bounds(rows);
  let share = CELL;
  for (;;) {
    const [size, origin, cell]: [number[], number[], number[]] = [[], [], []];
    for (let axis = 0; axis < 3; axis++) {
      const margin = RADIUS[1] * spacing;
      let [from, to] = [low[axis]! - margin, high[axis]! + margin];
      let edge = share * spacing;
      if (container) {
        const [wall, other] = [container[0][axis]!, container[1][axis]!];
        edge = (other - wall) / Math.max(Math.round((other - wall) / edge), 1);
        // Two nodes behind each wall: one ends the water, one its slope.
        from = Math.max(wall + Math.floor((from - wall) / edge) * edge, wall - 2 * edge);
        to = Math.min(to, other + 2 * edge);
      }
      cell.push(edge);
      origin.push(from);
      size.push(Math.ceil((to - from) / edge + 1e-3) + 1);
    }
    const nodes = size[0]! * size[1]! * size[2]!;
    if (nodes <= MOST_NODES) {
      return {
        size: size as Vector,
        origin: origin as Vector,
        cell: cell as Vector,
        values: new Float32Array(nodes),
        smooth: new Float32Array(nodes),
      };
    }
    share *= 1.2;
  }
}

/** Adds the kernels of the particles: those of free ones to the field, others beside it. */
function splat(moved: Float32Array, spacing: number, field: Field, held: Float32Array): void {
  const { size, origin, cell, smooth } = field;
  const [nx, ny, nz] = size;
  const [cx, cy, cz] = cell;
  for (let at = 0; at < moved.length; at += 5) {
    const [free, radius] = [moved[at + 3]!, moved[at + 4]!];
    const [px, py, pz] = [(moved[at]! - origin[0]) / cx, (moved[at + 1]! - origin[1]) / cy, (moved[at + 2]! - origin[2]) / cz];
    const peak = 1.567 * (spacing / radius) ** 3;
    const [rx, ry, rz] = [radius / cx, radius / cy, radius / cz];
    const [i0, i1] = [Math.max(Math.ceil(px - rx), 0), Math.min(Math.floor(px + rx), nx - 1)];
    const [j0, j1] = [Math.max(Math.ceil(py - ry), 0), Math.min(Math.floor(py + ry), ny - 1)];
    const [k0, k1] = [Math.max(Math.ceil(pz - rz), 0), Math.min(Math.floor(pz + rz), nz - 1)];
    for (let k = k0; k <= k1; k++) {
      const z = (k - pz) / rz;
      for (let j = j0; j <= j1; j++) {
        const y = (j - py) / ry;
        const rest = 1 - y * y - z * z;
        if (rest <= 0) continue;
        const base = nx * (j + ny * k);
        for (let i = i0; i <= i1; i++) {
          const x = (i - px) / rx;
          const left = rest - x * x;
          if (left <= 0) continue;
          const value = peak * left * left * left;
          smooth[base + i]! += free * value;
          held[base + i]! += (1 - free) * value;
        }
      }
    }
  }
}

/** Air outside of the container. */
function cutAtWalls(field: Field, container: [Vector, Vector]): void {
  const { size, origin, cell, values } = field;
  const isOutside = size.map((count, axis) => {
    const near = 0.1 * cell[axis]!;
    return Uint8Array.from({ length: count }, (_, index) => {
      const x = origin[axis]! + index * cell[axis]!;
      return Number(x < container[0][axis]! - near || x > container[1][axis]! + near);
    });
  });
  let at = 0;
  for (let k = 0; k < size[2]; k++) {
    for (let j = 0; j < size[1]; j++) {
      const isRowOutside = isOutside[1]![j]! | isOutside[2]![k]!;
      for (let i = 0; i < size[0]; i++, at++) {
        if (isRowOutside | isOutside[0]![i]!) values[at] = -0.5;
      }
    }
  }
}
