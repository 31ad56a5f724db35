// Steps the world, apart from the page that draws it.

import { Hand } from "./hand";
import type { Frame, Reply, Request } from "./messages";
import { Column, type Description, Module, Refusal } from "./module";

let world: Module | null = null;
let hand: Hand | null = null;
let description: Description | null = null;
let isRunning = false;
let isDue = false;
/** When the next frame is due (ms). */
let due = 0;
let timing = { frame: 0, steps: 0 };

const post = (reply: Reply, transfer: Transferable[] = []): void => {
  (self as unknown as Worker).postMessage(reply, transfer);
};

function frameOf(module: Module): Frame {
  const particles = module.floats(Column.particlePositions);
  const interiors = module.floats(Column.particleInteriors);
  for (let row = 0; 4 * row < particles.length; row++) particles[4 * row + 3] = interiors[row] ?? 0;
  return {
    particles,
    nodes: module.floats(Column.nodePositions),
    saturations: module.floats(Column.nodeSaturations),
    bodies: module.floats(Column.bodies),
  };
}

function show(module: Module): void {
  const frame = frameOf(module);
  const transfer = [frame.particles.buffer, frame.nodes.buffer, frame.saturations.buffer, frame.bodies.buffer];
  post({ kind: "frame", frame, status: module.status(), timing, isRunning }, transfer);
}

function begin(module: Module, found: Description, runs: boolean): void {
  description = found;
  hand = new Hand(module, found);
  timing = { frame: 0, steps: 0 };
  const rests = module.floats(Column.nodeRests);
  post({ kind: "stage", stage: { description: found, rests, triangles: module.words(Column.triangles) } });
  run(module, runs);
}

function run(module: Module, runs: boolean): void {
  isRunning = runs;
  due = performance.now();
  schedule(0);
  show(module);
}

function advance(module: Module): void {
  const before = module.status();
  const isPlaying = before.playing !== null;
  if (!isPlaying) hand?.act(1 / (description?.frame_rate ?? 60));
  const start = performance.now();
  module.frame();
  timing = { frame: performance.now() - start, steps: module.status().steps - before.steps };
  const playing = module.status().playing;
  if (playing && playing[0] === playing[1] && isRunning) {
    isRunning = false;
    post({ kind: "note", text: `The recording is verified: all ${playing[1]} frames have the recorded bits.` });
  }
}

/** Frames one after another, at most as fast as time passes; messages come between them. */
function loop(): void {
  isDue = false;
  if (!isRunning || !world) return;
  act(() => {
    advance(world!);
    show(world!);
  });
  const now = performance.now();
  due = Math.max(due + 1000 / (description?.frame_rate ?? 60), now - 100);
  schedule(due - now);
}

function schedule(wait: number): void {
  if (isDue || !isRunning) return;
  isDue = true;
  setTimeout(loop, Math.max(wait, 0));
}

/** Tells the page of what fails. What is refused stops nothing; what has failed stops the run. */
function act(what: () => void): void {
  try {
    what();
  } catch (error) {
    isRunning = false;
    const text = error instanceof Error ? error.message : String(error);
    post({ kind: "failure", text });
    if (world && error instanceof Refusal) show(world);
  }
}

function open(module: Module, name: string, bytes: Uint8Array): Description {
  const kind = new TextDecoder().decode(bytes.subarray(0, 8));
  if (kind === "sorbrecd") return module.play(bytes);
  if (kind.startsWith("sorb")) return module.restore(bytes);
  if (!name.endsWith(".toml")) throw new Refusal(`${name} is neither a scene (.toml) nor a recording nor a save of sorb`);
  // A line break tells TOML from a name.
  return module.load({ scene: `${new TextDecoder().decode(bytes)}\n` });
}

function answer(module: Module, request: Request): void {
  switch (request.kind) {
    case "load":
      return begin(module, module.load(request.load), request.isRunning);
    case "open":
      return begin(module, open(module, request.name, request.bytes), request.isRunning);
    case "run":
      return run(module, request.isRunning);
    case "step":
      module.step();
      return show(module);
    case "frames":
      for (let count = 0; count < request.count; count++) advance(module);
      show(module);
      return post({ kind: "done", id: request.id, status: module.status() });
    case "command":
      return module.command(request.command);
    case "take": {
      const hit = module.cast(request.origin, request.direction, false);
      const what = hit && !module.status().playing ? hand!.take(hit) : "";
      return post({ kind: "taken", id: request.id, point: what === "" ? null : hit!.point, what });
    }
    case "move":
      return hand!.move(request.point);
    case "pour":
      return hand!.pour(request.point);
    case "let_go":
      return hand!.letGo();
    case "record":
      module.record(60);
      return show(module);
    case "end_recording": {
      const bytes = module.endRecording();
      post({ kind: "file", name: `${description!.name}.rec`, bytes });
      return show(module);
    }
    case "save":
      return post({ kind: "file", name: `${description!.name}.sorb`, bytes: module.save() });
  }
}

async function start(): Promise<void> {
  const response = await fetch("sorb.wasm");
  if (!response.ok) throw new Error(`sorb.wasm: ${response.status} ${response.statusText}`);
  world = await Module.of(await response.arrayBuffer());
  const presets = world.presets().map(({ name, title }) => ({ name, title }));
  post({ kind: "ready", presets, schema: world.schema() });
}

self.onmessage = (event: MessageEvent<Request>) => {
  if (world) act(() => answer(world!, event.data));
};
start().catch((error: unknown) => post({ kind: "failure", text: String(error) }));
