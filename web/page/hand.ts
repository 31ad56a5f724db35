// The hand of the visitor: grips a sponge, pulls a body, pours water. All that it does are commands, which recordings hold.

import { Column, type Description, type Handle, type Hit, type Module, Refusal, type Vector } from "./module";
import { dot, length, minus, plus, times } from "./vector";

/** Fastest motion of a hand (m/s): water and sponge follow it. */
const FASTEST = 0.8;
/** Angular frequency with which a pulled body follows (1/s), critically damped. */
const PULL = 14;
/** Largest force on a pulled body over its weight. */
const STRONGEST = 8;
/** Radius of a grip over the size of the sponge's surface elements. */
const GRIP = 1.6;
/** Radius of what is poured in a frame, over the spacing. */
const JET = 2.1;

type Held =
  | { kind: "sponge"; at: Vector }
  | { kind: "dynamic"; number: number; handle: Handle; offset: Vector; last: Vector }
  | { kind: "kinematic"; number: number; handle: Handle; offset: Vector; at: Vector };

export class Hand {
  private held: Held | null = null;
  private target: Vector = [0, 0, 0];
  /** Where water is poured. */
  private spout: Vector | null = null;
  /** The body that grips: without a contact, far above. */
  private grip: { handle: Handle; home: Vector; at: Vector } | null = null;

  constructor(
    private readonly module: Module,
    private readonly description: Description,
  ) {}

  /** Takes what was hit; the name of what that is, empty for what does not move. */
  take(hit: Hit): string {
    this.letGo();
    this.target = hit.point;
    if (hit.kind === "sponge") {
      this.gripNodes(hit.point);
      return "sponge";
    }
    const body = this.description.bodies[hit.number];
    if (!body || hit.handle === null || body.kind === "fixed") return "";
    const centre = this.centre(hit.number);
    const offset = minus(centre, hit.point);
    const own = { number: hit.number, handle: hit.handle, offset };
    this.held = body.kind === "dynamic" ? { kind: "dynamic", ...own, last: centre } : { kind: "kinematic", ...own, at: centre };
    return body.name;
  }

  move(point: Vector): void {
    this.target = point;
  }

  pour(point: Vector | null): void {
    this.spout = point;
  }

  letGo(): void {
    const held = this.held;
    this.held = null;
    if (held?.kind === "sponge") {
      this.module.command({ release: { nodes: { rows: this.allNodes() } } });
    } else if (held?.kind === "dynamic") {
      this.module.command({ force: { body: held.handle, force: [0, 0, 0], torque: [0, 0, 0] } });
    }
  }

  /** Commands of the next frame, which takes so long (s). */
  act(duration: number): void {
    if (this.spout) this.pourAt(this.spout);
    const held = this.held;
    if (held?.kind === "sponge" && this.grip) {
      held.at = towards(held.at, this.target, FASTEST * duration);
      const at = plus(this.grip.home, minus(held.at, this.grip.at));
      this.module.command({ pose: { body: this.grip.handle, position: at, rotation: [0, 0, 0, 1], duration } });
    } else if (held?.kind === "kinematic") {
      held.at = towards(held.at, plus(this.target, held.offset), FASTEST * duration);
      this.module.command({ pose: { body: held.handle, position: held.at, rotation: this.rotation(held.number), duration } });
    } else if (held?.kind === "dynamic") {
      this.pull(held, duration);
    }
  }

  private pull(held: Held & { kind: "dynamic" }, duration: number): void {
    const centre = this.centre(held.number);
    const velocity = times(minus(centre, held.last), 1 / duration);
    held.last = centre;
    const inverseMass = this.module.floats(Column.bodies)[8 * held.number + 3] ?? 0;
    if (inverseMass <= 0) return;
    const gravity = this.module.status().gravity;
    const pull = minus(times(minus(plus(this.target, held.offset), centre), PULL * PULL), times(velocity, 2 * PULL));
    const most = STRONGEST * Math.max(length(gravity), 1);
    const size = length(pull);
    const acceleration = minus(size > most ? times(pull, most / size) : pull, gravity);
    this.module.command({ force: { body: held.handle, force: times(acceleration, 1 / inverseMass), torque: [0, 0, 0] } });
  }

  private gripNodes(point: Vector): void {
    const top = this.description.container?.[1][1] ?? 1;
    const home: Vector = [0, top + 1, 0];
    if (!this.grip) {
      const handle = this.module.status().next_body;
      const description = { name: "hand", kind: "kinematic", shape: { kind: "sphere", radius: 0.001 }, position: home };
      this.module.command({ add_body: { body: handle, description } });
      this.grip = { handle, home, at: point };
    }
    // From where the hand is now: it may have been moved before.
    this.grip.home = this.centreOf(this.grip.handle) ?? home;
    this.grip.at = point;
    const radius = GRIP * this.edge();
    this.module.command({ grip: { body: this.grip.handle, nodes: { sphere: { centre: point, radius } } } });
    this.held = { kind: "sponge", at: point };
  }

  private pourAt(point: Vector): void {
    const spacing = this.description.spacing;
    if (!spacing) return;
    const region = { sphere: { centre: point, radius: JET * spacing } };
    try {
      this.module.command({ pour: { region, velocity: [0, -0.6, 0] } });
    } catch (error) {
      // The last of it is still in the way.
      if (!(error instanceof Refusal)) throw error;
    }
  }

  /** Size of the elements of the sponges: the mean edge of a triangle at rest (m). */
  private edge(): number {
    const rests = this.module.floats(Column.nodeRests);
    const triangles = this.module.words(Column.triangles);
    const place = (node: number): Vector => [rests[4 * node]!, rests[4 * node + 1]!, rests[4 * node + 2]!];
    const count = Math.min(triangles.length / 3, 100);
    let sum = 0;
    for (let index = 0; index < count; index++) {
      sum += length(minus(place(triangles[3 * index]!), place(triangles[3 * index + 1]!)));
    }
    return count > 0 ? sum / count : 0.01;
  }

  private allNodes(): number[] {
    return Array.from({ length: this.description.nodes }, (_, node) => node);
  }

  private centre(number: number): Vector {
    const bodies = this.module.floats(Column.bodies);
    return [bodies[8 * number]!, bodies[8 * number + 1]!, bodies[8 * number + 2]!];
  }

  private centreOf(handle: Handle): Vector | null {
    const number = typeof handle === "number" ? handle : handle.index;
    const centre = this.centre(number);
    return Number.isFinite(dot(centre, centre)) ? centre : null;
  }

  private rotation(number: number): number[] {
    return Array.from(this.module.floats(Column.bodies).subarray(8 * number + 4, 8 * number + 8));
  }
}

function towards(from: Vector, to: Vector, most: number): Vector {
  const way = minus(to, from);
  const size = length(way);
  return size > most ? plus(from, times(way, most / size)) : to;
}
