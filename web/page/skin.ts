// The skin of the sponges, made for drawing from the nodes.

import type { Frame, Stage } from "./messages";

/** Steps that smooth the skin: a lattice that is cut along its planes has a zigzag surface. Each shrinks, and grows again (Taubin). */
const TAUBIN = [0.5, -0.52, 0.5, -0.52];
/** Steps after each of the divisions of all triangles into four. */
const AFTER = [[0.5, -0.25, 0.5], [0.5]];
/** Triangles above which they are not divided again. */
const MOST = 24_000;

/** The neighbours of vertices. */
class Neighbours {
  private readonly list: Uint32Array;
  private readonly starts: Uint32Array;

  constructor(triangles: Uint32Array, count: number) {
    const sets = Array.from({ length: count }, () => new Set<number>());
    for (let at = 0; at < triangles.length; at += 3) {
      const corners = triangles.subarray(at, at + 3);
      for (const a of corners) for (const b of corners) if (a !== b) sets[a]!.add(b);
    }
    this.list = Uint32Array.from(sets.flatMap((set) => [...set]));
    this.starts = new Uint32Array(count + 1);
    sets.forEach((set, index) => (this.starts[index + 1] = this.starts[index]! + set.size));
  }

  /** Moves every vertex by a share of the way to the mean of its neighbours, for every share. */
  smooth(points: Float32Array, shares: number[]): Float32Array {
    let from: Float32Array = points;
    let to: Float32Array = new Float32Array(points.length);
    for (const share of shares) {
      for (let own = 0; 3 * own < from.length; own++) {
        const [start, end] = [this.starts[own]!, this.starts[own + 1]!];
        let [x, y, z] = [0, 0, 0];
        for (let at = start; at < end; at++) {
          const other = 3 * this.list[at]!;
          x += from[other]!;
          y += from[other + 1]!;
          z += from[other + 2]!;
        }
        const part = share / Math.max(end - start, 1);
        to[3 * own] = from[3 * own]! * (1 - share) + part * x;
        to[3 * own + 1] = from[3 * own + 1]! * (1 - share) + part * y;
        to[3 * own + 2] = from[3 * own + 2]! * (1 - share) + part * z;
      }
      [from, to] = [to, from];
    }
    return from;
  }
}

/** A division of all triangles into four: new vertices are in the middles of edges. */
interface Division {
  /** Both ends of the edge of every new vertex. */
  ends: Uint32Array;
  neighbours: Neighbours;
  shares: number[];
}

function divide(triangles: Uint32Array, count: number): { ends: Uint32Array; triangles: Uint32Array } {
  const numbers = new Map<number, number>();
  const ends: number[] = [];
  const half = (a: number, b: number): number => {
    const key = Math.min(a, b) * 2 ** 24 + Math.max(a, b);
    let number = numbers.get(key);
    if (number === undefined) {
      number = count + numbers.size;
      numbers.set(key, number);
      ends.push(a, b);
    }
    return number;
  };
  const out: number[] = [];
  for (let at = 0; at < triangles.length; at += 3) {
    const [a, b, c] = [triangles[at]!, triangles[at + 1]!, triangles[at + 2]!];
    const [ab, bc, ca] = [half(a, b), half(b, c), half(c, a)];
    out.push(a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca);
  }
  return { ends: Uint32Array.from(ends), triangles: Uint32Array.from(out) };
}

export class Skin {
  readonly indices: Uint32Array;
  /** Nodes of the surface. */
  private readonly nodes: Uint32Array;
  private readonly neighbours: Neighbours;
  private readonly divisions: Division[] = [];
  private readonly rests: Float32Array;

  constructor(stage: Stage) {
    const number = new Map<number, number>();
    let triangles: Uint32Array = stage.triangles.map((node) => {
      if (!number.has(node)) number.set(node, number.size);
      return number.get(node)!;
    });
    this.nodes = Uint32Array.from(number.keys());
    let count = this.nodes.length;
    this.neighbours = new Neighbours(triangles, count);
    for (const shares of AFTER) {
      if ((4 * triangles.length) / 3 > MOST) break;
      const divided = divide(triangles, count);
      triangles = divided.triangles;
      count += divided.ends.length / 2;
      this.divisions.push({ ends: divided.ends, neighbours: new Neighbours(triangles, count), shares });
    }
    this.indices = triangles;
    this.rests = this.smoothed(stage.rests);
  }

  get isEmpty(): boolean {
    return this.indices.length === 0;
  }

  /** Position, normal, place at rest and saturation of every vertex. */
  vertices(frame: Frame): Float32Array {
    const positions = this.smoothed(frame.nodes);
    const normals = this.normals(positions);
    const count = positions.length / 3;
    const saturations = new Float32Array(count);
    this.nodes.forEach((node, index) => (saturations[index] = Math.min(Math.max(frame.saturations[node] ?? 0, 0), 1)));
    let next = this.nodes.length;
    for (const { ends } of this.divisions) {
      for (let at = 0; at < ends.length; at += 2) {
        saturations[next++] = 0.5 * (saturations[ends[at]!]! + saturations[ends[at + 1]!]!);
      }
    }
    const out = new Float32Array(10 * count);
    for (let index = 0; index < count; index++) {
      const at = 10 * index;
      for (let axis = 0; axis < 3; axis++) {
        out[at + axis] = positions[3 * index + axis]!;
        out[at + 3 + axis] = normals[3 * index + axis]!;
        out[at + 6 + axis] = this.rests[3 * index + axis]!;
      }
      out[at + 9] = saturations[index]!;
    }
    return out;
  }

  /** The skin of nodes, which have four numbers each. */
  private smoothed(nodes: Float32Array): Float32Array {
    let points = new Float32Array(3 * this.nodes.length);
    this.nodes.forEach((node, index) => points.set(nodes.subarray(4 * node, 4 * node + 3), 3 * index));
    points = Float32Array.from(this.neighbours.smooth(points, TAUBIN));
    for (const { ends, neighbours, shares } of this.divisions) {
      const finer = new Float32Array(points.length + 1.5 * ends.length);
      finer.set(points);
      let to = points.length;
      for (let at = 0; at < ends.length; at += 2) {
        for (let axis = 0; axis < 3; axis++) {
          finer[to++] = 0.5 * (points[3 * ends[at]! + axis]! + points[3 * ends[at + 1]! + axis]!);
        }
      }
      points = Float32Array.from(neighbours.smooth(finer, shares));
    }
    return points;
  }

  /** Sums of the normals of the triangles, by their area. */
  private normals(p: Float32Array): Float32Array {
    const out = new Float32Array(p.length);
    for (let at = 0; at < this.indices.length; at += 3) {
      const [a, b, c] = [3 * this.indices[at]!, 3 * this.indices[at + 1]!, 3 * this.indices[at + 2]!];
      const [ux, uy, uz] = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!];
      const [vx, vy, vz] = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!];
      const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      for (const corner of [a, b, c]) {
        out[corner]! += x;
        out[corner + 1]! += y;
        out[corner + 2]! += z;
      }
    }
    return out;
  }
}

/** Edge of the texture of pores. */
const PORES = 64;

/** Distances from the nearest of random pores, periodic, over the edge: 0 in the middle of a pore, 255 far from all. */
export function pores(gl: WebGL2RenderingContext): WebGLTexture {
  const depths = new Float32Array(PORES ** 3).fill(1);
  let seed = 12345;
  const random = (): number => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
  for (let pore = 0; pore < 700; pore++) {
    const centre = [random() * PORES, random() * PORES, random() * PORES];
    const radius = 1.3 + 4.8 * random() ** 4;
    const reach = Math.ceil(radius + 3);
    const [cx, cy, cz] = centre.map(Math.floor) as [number, number, number];
    for (let k = -reach; k <= reach; k++) {
      for (let j = -reach; j <= reach; j++) {
        for (let i = -reach; i <= reach; i++) {
          const distance = Math.hypot(cx + i - centre[0]!, cy + j - centre[1]!, cz + k - centre[2]!) - radius;
          const wrap = (x: number): number => ((x % PORES) + PORES) % PORES;
          const at = wrap(cx + i) + PORES * (wrap(cy + j) + PORES * wrap(cz + k));
          depths[at] = Math.min(depths[at]!, 0.5 + distance / 6);
        }
      }
    }
  }
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_3D, texture);
  gl.texStorage3D(gl.TEXTURE_3D, 1, gl.R8, PORES, PORES, PORES);
  const bytes = Uint8Array.from(depths, (depth) => Math.round(255 * Math.min(Math.max(depth, 0), 1)));
  gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, PORES, PORES, PORES, gl.RED, gl.UNSIGNED_BYTE, bytes);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  return texture;
}
