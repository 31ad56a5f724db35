// What the page and its workers tell each other.

import type { Description, Load, Status, Vector } from "./module";

export type Request =
  | { kind: "load"; load: Load; isRunning: boolean }
  | { kind: "open"; name: string; bytes: Uint8Array; isRunning: boolean }
  | { kind: "run"; isRunning: boolean }
  | { kind: "step" }
  | { kind: "frames"; count: number; id: number }
  | { kind: "command"; command: unknown }
  | { kind: "take"; origin: Vector; direction: Vector; id: number }
  | { kind: "move"; point: Vector }
  | { kind: "pour"; point: Vector | null }
  | { kind: "let_go" }
  | { kind: "record" }
  | { kind: "end_recording" }
  | { kind: "save" };

/** A state to draw. */
export interface Frame {
  /** x, y, z and the share that sponges hold. */
  particles: Float32Array<ArrayBuffer>;
  /** x, y, z, inverse mass. */
  nodes: Float32Array<ArrayBuffer>;
  saturations: Float32Array<ArrayBuffer>;
  /** Centre, inverse mass, rotation. */
  bodies: Float32Array<ArrayBuffer>;
}

/** What does not change from step to step. */
export interface Stage {
  description: Description;
  rests: Float32Array<ArrayBuffer>;
  triangles: Uint32Array<ArrayBuffer>;
}

export interface Timing {
  /** Time that the last frame took (ms). */
  frame: number;
  /** Steps of the last frame. */
  steps: number;
}

export type Reply =
  | { kind: "ready"; presets: { name: string; title: string }[]; schema: unknown }
  | { kind: "stage"; stage: Stage }
  | { kind: "frame"; frame: Frame; status: Status; timing: Timing; isRunning: boolean }
  | { kind: "done"; id: number; status: Status }
  | { kind: "taken"; id: number; point: Vector | null; what: string }
  | { kind: "file"; name: string; bytes: Uint8Array<ArrayBuffer> }
  | { kind: "note"; text: string }
  | { kind: "failure"; text: string };

/** The surface of the water: x, y, z and the normal of every vertex, and triangles. */
export interface Surface {
  vertices: Float32Array<ArrayBuffer>;
  indices: Uint32Array<ArrayBuffer>;
}

export interface SurfaceRequest {
  particles: Float32Array<ArrayBuffer>;
  spacing: number;
  container: [Vector, Vector] | null;
}
