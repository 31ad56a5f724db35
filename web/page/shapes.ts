// Meshes of bodies: positions and normals, in the frame of the body.

import { Mesh } from "./gl";
import type { Shape, Vector } from "./module";
import { cross, minus, unit } from "./vector";

const AROUND = 48;

/** A cube from -1 to 1. */
export function cuboid(gl: WebGL2RenderingContext): Mesh {
  const vertices: number[] = [];
  const indices: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const side of [-1, 1]) {
      const first = vertices.length / 6;
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const) {
        const point = [0, 0, 0];
        const normal = [0, 0, 0];
        point[axis] = normal[axis] = side;
        point[(axis + 1) % 3] = u;
        point[(axis + 2) % 3] = v * side;
        vertices.push(...point, ...normal);
      }
      indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  }
  return new Mesh(gl, [3, 3]).fill(new Float32Array(vertices), new Uint32Array(indices));
}

/** A ball that is swept along y; without a sweep a ball. */
function capsule(gl: WebGL2RenderingContext, radius: number, halfHeight: number): Mesh {
  const vertices: number[] = [];
  const indices: number[] = [];
  const rows = AROUND / 2;
  for (let row = 0; row <= rows + 1; row++) {
    // The equator is there twice, at both ends of the sweep.
    const step = row > rows / 2 ? row - 1 : row;
    const polar = (Math.PI * step) / rows;
    const [y, ring] = [Math.cos(polar), Math.sin(polar)];
    for (let column = 0; column <= AROUND; column++) {
      const azimuth = (2 * Math.PI * column) / AROUND;
      const [x, z] = [ring * Math.sin(azimuth), ring * Math.cos(azimuth)];
      vertices.push(radius * x, radius * y + (row > rows / 2 ? -halfHeight : halfHeight), radius * z, x, y, z);
      if (row <= rows && column < AROUND) {
        const at = row * (AROUND + 1) + column;
        indices.push(at, at + AROUND + 1, at + 1, at + 1, at + AROUND + 1, at + AROUND + 2);
      }
    }
  }
  return new Mesh(gl, [3, 3]).fill(new Float32Array(vertices), new Uint32Array(indices));
}

/** Flat triangles. */
function facets(gl: WebGL2RenderingContext, corners: Vector[], triangles: Vector[]): Mesh {
  const vertices: number[] = [];
  for (const triangle of triangles) {
    const [a, b, c] = triangle.map((corner) => corners[corner]!) as [Vector, Vector, Vector];
    const normal = unit(cross(minus(b, a), minus(c, a)));
    for (const corner of [a, b, c]) vertices.push(...corner, ...normal);
  }
  return new Mesh(gl, [3, 3]).fill(new Float32Array(vertices), Uint32Array.from(vertices.slice(0, vertices.length / 6).keys()));
}

/** The mesh of a shape and the scale along its axes; none for a plane, which has no end. */
export function shapeMesh(gl: WebGL2RenderingContext, shape: Shape): { mesh: Mesh; scale: Vector } | null {
  switch (shape.kind) {
    case "plane":
      return null;
    case "sphere":
      return { mesh: capsule(gl, 1, 0), scale: [shape.radius, shape.radius, shape.radius] };
    case "cuboid":
      return { mesh: cuboid(gl), scale: shape.half_extents };
    case "capsule":
      return { mesh: capsule(gl, shape.radius, shape.half_height), scale: [1, 1, 1] };
    case "mesh":
      return { mesh: facets(gl, shape.vertices, shape.triangles), scale: [1, 1, 1] };
  }
}
