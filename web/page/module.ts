// The module for WebAssembly behind its exports. src/lib.rs says what every function takes and answers.

interface Exports {
  memory: WebAssembly.Memory;
  room(length: number): number;
  answer(): number;
  answer_length(): number;
  panic_message(): number;
  panic_length(): number;
  presets(): number;
  schema(): number;
  load(): number;
  describe(): number;
  step(): number;
  frame(): number;
  status(): number;
  digest(): bigint;
  command(): number;
  cast(): number;
  save(): number;
  restore(): number;
  record(every: number): number;
  end_recording(): number;
  play(): number;
  verify(): number;
  column(number: number): number;
  column_length(number: number): number;
}

export type Vector = [number, number, number];

/** Numbers of the columns, as `COLUMNS` of src/columns.rs has them. */
export const Column = {
  particlePositions: 0,
  particleVelocities: 1,
  particleInteriors: 2,
  nodePositions: 3,
  nodeRests: 4,
  nodeSaturations: 5,
  triangles: 6,
  bodies: 7,
} as const;

export interface Load {
  /** Name of a scene of the library, or TOML. */
  scene: string;
  resolution?: number;
  /** Changes such as `fluid.viscosity=1e-5`. */
  set?: string[];
  simd?: string;
}

export type Shape =
  | { kind: "plane" }
  | { kind: "sphere"; radius: number }
  | { kind: "cuboid"; half_extents: Vector }
  | { kind: "capsule"; half_height: number; radius: number }
  | { kind: "mesh"; vertices: Vector[]; triangles: Vector[] };

export interface BodyDescription {
  name: string;
  kind: "dynamic" | "fixed" | "kinematic";
  shape: Shape;
  look: "solid" | "glass" | "wire" | null;
  colour: Vector | null;
  removed: boolean;
}

export interface Description {
  name: string;
  title: string;
  duration: number;
  frame_rate: number;
  spacing: number | null;
  container: [Vector, Vector] | null;
  camera: { eye: Vector; target: Vector; field_of_view_degrees: number };
  bodies: BodyDescription[];
  materials: Record<string, number>[];
  viscosity: number | null;
  gravity: Vector;
  nodes: number;
  simd: string;
}

/** A handle of a body: its number, or more where another body had that number before. */
export type Handle = number | { index: number; generation: number };

export interface Status {
  time: number;
  steps: number;
  frames: number;
  particles: number;
  absorbed: number;
  particle_mass: number;
  bodies: number;
  next_body: Handle;
  next_flow: number;
  gravity: Vector;
  recorded: boolean;
  /** Frame and number of frames of a recording that plays. */
  playing: [number, number] | null;
  digest: string;
}

export interface Hit {
  kind: "body" | "sponge" | "water";
  number: number;
  handle: Handle | null;
  distance: number;
  point: Vector;
  normal: Vector;
}

/** A function of the module has refused something. */
export class Refusal extends Error {}

/** simd128, as a module of one function that uses it. */
const SIMD_PROBE = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

export function hasSimd(): boolean {
  return WebAssembly.validate(SIMD_PROBE);
}

export class Module {
  private readonly text = new TextEncoder();

  private constructor(private readonly exports: Exports) {}

  static async of(bytes: BufferSource): Promise<Module> {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    return new Module(instance.exports as unknown as Exports);
  }

  presets(): { name: string; title: string; text: string }[] {
    return this.json("presets");
  }

  schema(): unknown {
    return this.json("schema");
  }

  load(load: Load): Description {
    return this.json("load", JSON.stringify(load));
  }

  describe(): Description {
    return this.json("describe");
  }

  step(): void {
    this.call("step");
  }

  frame(): void {
    this.call("frame");
  }

  status(): Status {
    return this.json("status");
  }

  digest(): string {
    return BigInt.asUintN(64, this.exports.digest()).toString(16).padStart(16, "0");
  }

  command(command: unknown): void {
    this.call("command", JSON.stringify(command));
  }

  cast(origin: Vector, direction: Vector, water: boolean): Hit | null {
    return this.json("cast", JSON.stringify({ origin, direction, water }));
  }

  save(): Uint8Array<ArrayBuffer> {
    return this.call("save").slice();
  }

  restore(save: Uint8Array): Description {
    return this.json("restore", save);
  }

  record(every: number): void {
    this.checked(() => this.exports.record(every));
  }

  endRecording(): Uint8Array<ArrayBuffer> {
    return this.call("end_recording").slice();
  }

  play(recording: Uint8Array): Description {
    return this.json("play", recording);
  }

  /** The number of frames, all of which are as recorded. */
  verify(recording: Uint8Array): number {
    return this.json("verify", recording);
  }

  /** A copy of a column. */
  floats(column: number): Float32Array<ArrayBuffer> {
    const at = this.exports.column(column);
    const length = this.exports.column_length(column) / 4;
    return length === 0 ? new Float32Array(0) : new Float32Array(this.exports.memory.buffer, at, length).slice();
  }

  words(column: number): Uint32Array<ArrayBuffer> {
    return new Uint32Array(this.floats(column).buffer);
  }

  private json<T>(name: keyof Exports, input?: string | Uint8Array): T {
    return JSON.parse(new TextDecoder().decode(this.call(name, input))) as T;
  }

  private call(name: keyof Exports, input?: string | Uint8Array): Uint8Array<ArrayBuffer> {
    return this.checked(() => {
      if (input !== undefined) {
        const bytes = typeof input === "string" ? this.text.encode(input) : input;
        // Room first: memory that grows has another buffer.
        const at = this.exports.room(bytes.length);
        new Uint8Array(this.exports.memory.buffer, at, bytes.length).set(bytes);
      }
      return (this.exports[name] as () => number)();
    });
  }

  /** The answer of a function; what it refuses is thrown, and so is the text of a panic. */
  private checked(call: () => number): Uint8Array<ArrayBuffer> {
    let status: number;
    try {
      status = call();
    } catch (error) {
      const text = this.bytes(this.exports.panic_message(), this.exports.panic_length());
      throw new Error(`the module has ended: ${new TextDecoder().decode(text) || String(error)}`);
    }
    const answer = this.bytes(this.exports.answer(), this.exports.answer_length());
    if (status !== 0) throw new Refusal(new TextDecoder().decode(answer));
    return answer;
  }

  private bytes(at: number, length: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.exports.memory.buffer as ArrayBuffer, at, length);
  }
}
