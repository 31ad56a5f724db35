// The surface of the water: where a density field on a grid is half of that of water, as triangles.
//
// Particles of a page are few and large. Drawn as spheres they leave scallops along every outline, which no filter of depths takes away;
// the field has none. Mirror images behind the walls make the surface meet them at a right angle.

import { density, type Field } from "./density";
import type { Surface, SurfaceRequest } from "./messages";
import type { Vector } from "./module";

/** Edges of a cell: corner and axis. Corners are numbered x + 2 y + 4 z. */
const EDGES: [number, number][] = [];
for (let corner = 0; corner < 8; corner++) {
  for (const step of [1, 2, 4]) if (!(corner & step)) EDGES.push([corner, corner | step]);
}

/** Vertices and triangles that grow. */
class Mesh {
  vertices = new Float32Array(6 * 8192);
  indices = new Uint32Array(3 * 16384);
  vertexCount = 0;
  indexCount = 0;

  vertex(x: number, y: number, z: number): number {
    if (6 * (this.vertexCount + 1) > this.vertices.length) {
      const grown = new Float32Array(2 * this.vertices.length);
      grown.set(this.vertices);
      this.vertices = grown;
    }
    const at = 6 * this.vertexCount;
    this.vertices[at] = x;
    this.vertices[at + 1] = y;
    this.vertices[at + 2] = z;
    return this.vertexCount++;
  }

  quad(a: number, b: number, c: number, d: number): void {
    if (this.indexCount + 6 > this.indices.length) {
      const grown = new Uint32Array(2 * this.indices.length);
      grown.set(this.indices);
      this.indices = grown;
    }
    const { indices, indexCount: at } = this;
    indices[at] = a;
    indices[at + 1] = b;
    indices[at + 2] = c;
    indices[at + 3] = a;
    indices[at + 4] = c;
    indices[at + 5] = d;
    this.indexCount += 6;
  }
}

/** Naive surface nets: a vertex in every cell that the surface crosses, a quad for every edge that it crosses. */
export function surface(request: SurfaceRequest): Surface {
  const field = density(request);
  if (!field) return { vertices: new Float32Array(0), indices: new Uint32Array(0) };
  const mesh = new Mesh();
  const cells = vertices(field, mesh, request.container);
  quads(field, cells, mesh);
  normals(field, mesh, request.container);
  return { vertices: mesh.vertices.slice(0, 6 * mesh.vertexCount), indices: mesh.indices.slice(0, mesh.indexCount) };
}

/** Puts a vertex into every cell with corners on both sides; the number of the vertex of each cell, or -1. */
function vertices(field: Field, mesh: Mesh, container: [Vector, Vector] | null): Int32Array {
  const { size, origin, cell, values } = field;
  const [nx, ny, nz] = size;
  const numbers = new Int32Array(nx * ny * nz).fill(-1);
  const offsets = [0, 1, nx, nx + 1, nx * ny, nx * ny + 1, nx * ny + nx, nx * ny + nx + 1];
  const corner = new Float32Array(8);
  for (let k = 0; k < nz - 1; k++) {
    for (let j = 0; j < ny - 1; j++) {
      for (let i = 0; i < nx - 1; i++) {
        const at = i + nx * (j + ny * k);
        let inside = 0;
        for (let c = 0; c < 8; c++) {
          const value = values[at + offsets[c]!]!;
          corner[c] = value;
          if (value > 0) inside++;
        }
        if (inside === 0 || inside === 8) continue;
        const place = crossing(corner);
        const point: Vector = [0, 1, 2].map((axis) => {
          const x = origin[axis]! + cell[axis]! * ([i, j, k][axis]! + place[axis]!);
          return container ? Math.min(Math.max(x, container[0][axis]!), container[1][axis]!) : x;
        }) as Vector;
        numbers[at] = mesh.vertex(...point);
      }
    }
  }
  return numbers;
}

const place: Vector = [0, 0, 0];

/** Mean of the points where the edges of a cell meet the surface, in cells. */
function crossing(corner: Float32Array): Vector {
  let count = 0;
  place[0] = place[1] = place[2] = 0;
  for (const [a, b] of EDGES) {
    const [from, to] = [corner[a]!, corner[b]!];
    if (from > 0 === to > 0) continue;
    const t = from / (from - to);
    for (let axis = 0; axis < 3; axis++) {
      const low = (a >> axis) & 1;
      place[axis]! += low + t * (((b >> axis) & 1) - low);
    }
    count++;
  }
  for (let axis = 0; axis < 3; axis++) place[axis]! /= count;
  return place;
}

/** Joins the vertices of the four cells around every edge that crosses the surface, wound outwards. */
function quads(field: Field, numbers: Int32Array, mesh: Mesh): void {
  const { size, values } = field;
  const [nx, ny, nz] = size;
  const steps = [1, nx, nx * ny];
  for (let k = 1; k < nz - 1; k++) {
    for (let j = 1; j < ny - 1; j++) {
      for (let i = 1; i < nx - 1; i++) {
        const at = i + nx * (j + ny * k);
        const isInside = values[at]! > 0;
        for (let axis = 0; axis < 3; axis++) {
          if (values[at + steps[axis]!]! > 0 === isInside) continue;
          const [u, v] = [steps[(axis + 1) % 3]!, steps[(axis + 2) % 3]!];
          const [a, b, c, d] = [numbers[at - u - v]!, numbers[at - v]!, numbers[at]!, numbers[at - u]!];
          if (a < 0 || b < 0 || c < 0 || d < 0) continue;
          if (isInside) mesh.quad(a, b, c, d);
          else mesh.quad(d, c, b, a);
        }
      }
    }
  }
}

/** Normals: down the field, and those of the walls on walls. */
function normals(field: Field, mesh: Mesh, container: [Vector, Vector] | null): void {
  const near = 1e-5;
  for (let vertex = 0; vertex < mesh.vertexCount; vertex++) {
    const at = 6 * vertex;
    const point = mesh.vertices.subarray(at, at + 3);
    const normal: Vector = [0, 0, 0];
    let isOnWall = false;
    for (let axis = 0; container && axis < 3; axis++) {
      if (point[axis]! <= container[0][axis]! + near) normal[axis] = -1;
      else if (point[axis]! >= container[1][axis]! - near) normal[axis] = 1;
      isOnWall ||= normal[axis] !== 0;
    }
    if (!isOnWall) {
      for (let axis = 0; axis < 3; axis++) {
        const step = 0.9 * field.cell[axis]!;
        normal[axis] = (sample(field, point, axis, -step) - sample(field, point, axis, step)) / step;
      }
    }
    const size = Math.hypot(...normal) || 1;
    for (let axis = 0; axis < 3; axis++) mesh.vertices[at + 3 + axis] = normal[axis]! / size;
  }
}

/** The field at a point that is moved along an axis, between the nodes by lines. */
function sample(field: Field, point: Float32Array, axis: number, move: number): number {
  const { size, origin, cell, smooth } = field;
  const [nx, ny] = size;
  let at = 0;
  const part = [0, 0, 0];
  for (let own = 2; own >= 0; own--) {
    const x = (point[own]! + (own === axis ? move : 0) - origin[own]!) / cell[own]!;
    const whole = Math.min(Math.max(Math.floor(x), 0), size[own]! - 2);
    part[own] = Math.min(Math.max(x - whole, 0), 1);
    at = at * size[own]! + whole;
  }
  const [u, v, w] = part as [number, number, number];
  const row = (base: number): number => smooth[base]! * (1 - u) + smooth[base + 1]! * u;
  const plane = (base: number): number => row(base) * (1 - v) + row(base + nx) * v;
  return plane(at) * (1 - w) + plane(at + nx * ny) * w;
}
