// Mouse and touch: what the first finger takes, and the camera for everything else.

import { type Camera, direction, type View } from "./camera";
import type { Request } from "./messages";
import type { Vector } from "./module";
import { dot, minus, plus, times } from "./vector";

type Mode = "idle" | "asking" | "holding" | "turning" | "pouring";

export class Pointer {
  tool: "hand" | "pour" = "hand";
  container: [Vector, Vector] | null = null;
  private mode: Mode = "idle";
  private readonly fingers = new Map<number, [number, number]>();
  private question = 0;
  /** The place that was taken: the hand moves in the plane through it that faces the eye. */
  private held: Vector = [0, 0, 0];
  private last: [number, number] = [0, 0];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: Camera,
    private readonly send: (request: Request) => void,
    private readonly changed: () => void,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  /** What the worker says about the question. */
  taken(id: number, point: Vector | null): void {
    if (id !== this.question || this.mode !== "asking") {
      if (point && id === this.question) this.send({ kind: "let_go" });
      return;
    }
    this.mode = point ? "holding" : "turning";
    if (!point) return;
    this.held = point;
    this.canvas.classList.add("holding");
    this.send({ kind: "move", point: this.inPlane(this.last, point) });
  }

  private down(event: PointerEvent): void {
    this.canvas.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.last = [event.clientX, event.clientY];
    if (this.fingers.size > 1 || event.button !== 0 || event.shiftKey) {
      this.letGo();
      this.mode = "turning";
    } else if (this.tool === "pour") {
      this.mode = "pouring";
      this.send({ kind: "pour", point: this.spout(this.last) });
    } else {
      this.mode = "asking";
      const view = this.view();
      const origin = view.eye;
      this.send({ kind: "take", origin, direction: this.ray(view, this.last), id: ++this.question });
    }
  }

  private moved(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const now: [number, number] = [event.clientX, event.clientY];
    if (this.fingers.size === 2) {
      const other = [...this.fingers].find(([id]) => id !== event.pointerId)![1];
      const spread = (at: [number, number]): number => Math.max(Math.hypot(at[0] - other[0], at[1] - other[1]), 1);
      this.camera.zoom(spread(before) / spread(now));
    }
    this.fingers.set(event.pointerId, now);
    this.last = now;
    if (this.mode === "turning") {
      this.camera.turn((now[0] - before[0]) * 0.006, (now[1] - before[1]) * 0.006);
      this.changed();
    } else if (this.mode === "holding") {
      this.send({ kind: "move", point: this.inPlane(now, this.held) });
    } else if (this.mode === "pouring") {
      this.send({ kind: "pour", point: this.spout(now) });
    }
  }

  private up(event: PointerEvent): void {
    this.fingers.delete(event.pointerId);
    if (this.fingers.size > 0) return;
    this.letGo();
    this.mode = "idle";
  }

  private letGo(): void {
    this.canvas.classList.remove("holding");
    if (this.mode === "holding") this.send({ kind: "let_go" });
    if (this.mode === "pouring") this.send({ kind: "pour", point: null });
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.camera.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.0015));
    this.changed();
  }

  private view(): View {
    return this.camera.view(this.canvas.clientWidth / this.canvas.clientHeight);
  }

  private ray(view: View, [x, y]: [number, number]): Vector {
    const place = this.canvas.getBoundingClientRect();
    return direction(view, (2 * (x - place.left)) / place.width - 1, 1 - (2 * (y - place.top)) / place.height);
  }

  /** The place under a finger in the plane through a point that faces the eye, in the container. */
  private inPlane(finger: [number, number], through: Vector): Vector {
    const view = this.view();
    const ray = this.ray(view, finger);
    const distance = dot(minus(through, view.eye), view.forward) / Math.max(dot(ray, view.forward), 0.05);
    const place = plus(view.eye, times(ray, distance));
    const { container } = this;
    if (!container) return place;
    return place.map((x, axis) => {
      const margin = 0.06 * (container[1][axis]! - container[0][axis]!);
      return Math.min(Math.max(x, container[0][axis]! + margin), container[1][axis]! - margin);
    }) as Vector;
  }

  /** Where water comes from: under the finger, in the upper part of the container. */
  private spout(finger: [number, number]): Vector {
    const [low, high] = this.container ?? [[-0.1, 0, -0.1], [0.1, 0.2, 0.1]];
    const height = high[1]! - low[1]!;
    const middle: Vector = [0.5 * (low[0]! + high[0]!), low[1]! + 0.7 * height, 0.5 * (low[2]! + high[2]!)];
    const point = this.inPlane(finger, middle);
    return [point[0], Math.max(point[1], low[1]! + 0.5 * height), point[2]];
  }
}
