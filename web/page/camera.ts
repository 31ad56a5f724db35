// A camera that turns around a point.

import type { Description, Vector } from "./module";
import { cross, length, lookAt, type Matrix, minus, perspective, plus, product, times, unit } from "./vector";

/** Nearest and farthest distance that is drawn (m). */
export const RANGE: [number, number] = [0.02, 12];

export interface View {
  eye: Vector;
  forward: Vector;
  /** Unit vectors of the picture. */
  right: Vector;
  above: Vector;
  /** Half the height of the picture at distance 1. */
  slope: number;
  aspect: number;
  matrix: Matrix;
}

export class Camera {
  private target: Vector = [0, 0.05, 0];
  private azimuth = 0;
  private elevation = 0.5;
  private distance = 0.5;
  private fieldOfView = 0.6;

  begin(description: Description): void {
    const { eye, target, field_of_view_degrees } = description.camera;
    const way = minus(eye, target);
    this.target = target;
    this.distance = length(way);
    this.azimuth = Math.atan2(way[0], way[2]);
    this.elevation = Math.asin(way[1] / this.distance);
    this.fieldOfView = (field_of_view_degrees * Math.PI) / 180;
  }

  turn(x: number, y: number): void {
    this.azimuth -= x;
    this.elevation = Math.min(Math.max(this.elevation + y, 0.02), 1.5);
  }

  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance * factor, 0.1), 4);
  }

  view(aspect: number): View {
    const flat = Math.cos(this.elevation);
    const way: Vector = [flat * Math.sin(this.azimuth), Math.sin(this.elevation), flat * Math.cos(this.azimuth)];
    // A narrow picture shows as much of the scene from farther away.
    const eye = plus(this.target, times(way, this.distance * Math.max(1, 1.25 / aspect)));
    const forward = unit(minus(this.target, eye));
    const right = unit(cross(forward, [0, 1, 0]));
    const matrix = product(perspective(this.fieldOfView, aspect, ...RANGE), lookAt(eye, this.target, [0, 1, 0]));
    return { eye, forward, right, above: cross(right, forward), slope: Math.tan(0.5 * this.fieldOfView), aspect, matrix };
  }
}

/** Direction of the ray through a place of the picture, from -1 to 1. */
export function direction(view: View, x: number, y: number): Vector {
  const across = plus(times(view.right, x * view.slope * view.aspect), times(view.above, y * view.slope));
  return unit(plus(view.forward, across));
}
