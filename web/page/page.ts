// The page: draws what a worker steps, and passes on what the visitor does.

import { Camera } from "./camera";
import { Drawing } from "./drawing";
import type { Frame, Reply, Request, Stage, Surface, SurfaceRequest, Timing } from "./messages";
import { type Description, hasSimd, type Load, type Status } from "./module";
import { Pointer } from "./pointer";
import { CHOICES } from "./scenes";
import { digits, showSliders } from "./sliders";

/** Most pixels of a picture, and pixels of it for one of the page. */
const MOST_PIXELS = 1_700_000;
const FINEST = 1.5;
/** Time from picture to picture that is too long (ms), and pictures over which it is looked at: then they become coarser. */
const SLOW = 40;
const LOOK = 20;
const COARSEST = 0.5;

const element = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

/** What a world is made of. */
type Source = Extract<Request, { kind: "load" | "open" }>;

let hiding = 0;

/** Shows a message; that of a failure stays until it is clicked. */
function tell(text: string, isFailure: boolean): void {
  const message = element("message");
  message.textContent = text;
  message.classList.toggle("failure", isFailure);
  message.hidden = false;
  message.onclick = () => (message.hidden = true);
  clearTimeout(hiding);
  if (!isFailure) hiding = window.setTimeout(() => (message.hidden = true), 8000);
}

class Page {
  private readonly drawing: Drawing;
  private readonly camera = new Camera();
  private readonly pointer: Pointer;
  private readonly worker = new Worker("worker.js", { type: "module" });
  private readonly surfaces = new Worker("surface_worker.js", { type: "module" });
  private readonly canvas = element<HTMLCanvasElement>("picture");
  private schema: unknown = null;
  private stage: Stage | null = null;
  private status: Status | null = null;
  private isRunning = true;
  private isStale = true;
  /** What reset loads again. */
  private source: Source | null = null;
  private changes: string[] = [];
  /** The state whose surface is being made, and the one after it. */
  private making: Frame | null = null;
  private next: Frame | null = null;
  /** Who waits for frames, by the number of the request. */
  private readonly waiting = new Map<number, (status: Status) => void>();
  private asked = 0;
  private stepTimes: number[] = [];
  /** Share of the pixels along each side, and pictures since it was looked at. */
  private share = 1;
  private drawn = { count: 0, since: 0 };

  constructor() {
    this.drawing = new Drawing(this.canvas);
    const changed = (): void => {
      this.isStale = true;
      element("hint").classList.add("gone");
    };
    this.pointer = new Pointer(this.canvas, this.camera, (request) => this.act(request), changed);
    this.worker.onmessage = (event: MessageEvent<Reply>) => this.hear(event.data);
    this.worker.onerror = (event) => tell(event.message, true);
    this.surfaces.onmessage = (event: MessageEvent<Surface>) => this.surfaceMade(event.data);
    this.surfaces.onerror = (event) => tell(event.message, true);
    this.canvas.addEventListener("webglcontextlost", () => tell("The graphics card was reset: load the page again.", true));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
    this.buttons();
    this.files();
    const draw = (now: number): void => {
      if (this.isStale && this.stage) {
        this.isStale = false;
        this.drawing.draw(this.camera.view(this.canvas.width / this.canvas.height));
        this.keepUp(now);
      } else {
        this.drawn = { count: 0, since: now };
      }
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  /** For tests: so many frames, and what the world says then. */
  frames(count: number): Promise<Status> {
    this.send({ kind: "run", isRunning: false });
    const id = this.asked++;
    this.send({ kind: "frames", count, id });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  private send(request: Request): void {
    this.worker.postMessage(request);
  }

  private act(request: Request): void {
    element("hint").classList.add("gone");
    this.send(request);
  }

  private load(request: Source): void {
    this.source = request;
    this.send({ ...request, isRunning: this.isRunning });
  }

  private choose(name: string): void {
    const choice = CHOICES.find((choice) => choice.name === name) ?? CHOICES[0]!;
    element<HTMLSelectElement>("scene").value = choice.name;
    this.changes = [];
    this.load({ kind: "load", load: choice.load, isRunning: this.isRunning });
  }

  private hear(reply: Reply): void {
    switch (reply.kind) {
      case "ready":
        this.schema = reply.schema;
        return this.begin();
      case "stage":
        return this.begun(reply.stage);
      case "frame":
        this.status = reply.status;
        this.isRunning = reply.isRunning;
        this.showStatus(reply.status, reply.timing);
        this.next = reply.frame;
        return this.makeSurface();
      case "done":
        this.waiting.get(reply.id)?.(reply.status);
        return void this.waiting.delete(reply.id);
      case "taken":
        return this.pointer.taken(reply.id, reply.point);
      case "file":
        return download(reply.name, reply.bytes);
      case "note":
        return tell(reply.text, false);
      case "failure":
        element("play").textContent = "Play";
        return tell(reply.text, true);
    }
  }

  private begin(): void {
    const query = new URLSearchParams(location.search);
    this.isRunning = !query.has("paused");
    const select = element<HTMLSelectElement>("scene");
    for (const { name, title } of CHOICES) select.add(new Option(title, name));
    select.onchange = () => this.choose(select.value);
    this.choose(query.get("scene") ?? CHOICES[0]!.name);
  }

  private begun(stage: Stage): void {
    const isOther = stage.description.name !== this.stage?.description.name;
    this.stage = stage;
    this.stepTimes = [];
    this.pointer.container = stage.description.container;
    if (isOther) this.camera.begin(stage.description);
    this.drawing.begin(stage);
    showSliders(element("sliders"), this.schema, stage.description, (what) => this.change(what, stage.description));
  }

  private change(what: { command: unknown } | { change: string }, description: Description): void {
    if ("command" in what) return this.act({ kind: "command", command: what.command });
    if (this.source?.kind !== "load") return tell(`${description.name} was opened from a file: change it there`, true);
    const key = what.change.split("=")[0]!;
    this.changes = [...this.changes.filter((own) => !own.startsWith(`${key}=`)), what.change];
    const load: Load = { ...this.source.load, set: this.changes };
    this.load({ ...this.source, load });
  }

  private makeSurface(): void {
    if (this.making || !this.next) return;
    const { description } = this.stage!;
    this.making = this.next;
    this.next = null;
    const request: SurfaceRequest = {
      particles: this.making.particles.slice(),
      spacing: description.spacing ?? 0.01,
      container: description.container,
    };
    this.surfaces.postMessage(request, [request.particles.buffer]);
  }

  private surfaceMade(surface: Surface): void {
    const frame = this.making!;
    this.making = null;
    this.drawing.show(frame, surface);
    this.isStale = true;
    this.makeSurface();
  }

  /** Draws coarser pictures where they follow each other too slowly. A world that steps slowly leaves pictures out in between. */
  private keepUp(now: number): void {
    if (++this.drawn.count < LOOK) return;
    const isSlow = now - this.drawn.since > LOOK * SLOW;
    this.drawn = { count: 0, since: now };
    if (!isSlow || this.share <= COARSEST) return;
    this.share = Math.max(0.8 * this.share, COARSEST);
    this.resize();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    const wanted = Math.min(devicePixelRatio, FINEST);
    const scale = Math.min(wanted, Math.sqrt(MOST_PIXELS / Math.max(clientWidth * clientHeight, 1))) * this.share;
    this.canvas.width = Math.max(Math.round(clientWidth * scale), 1);
    this.canvas.height = Math.max(Math.round(clientHeight * scale), 1);
    this.isStale = true;
  }

  private buttons(): void {
    const on = (id: string, act: () => void): void => void element(id).addEventListener("click", act);
    on("play", () => this.send({ kind: "run", isRunning: !this.isRunning }));
    on("step", () => {
      this.send({ kind: "run", isRunning: false });
      this.send({ kind: "step" });
    });
    on("reset", () => this.source && this.load(this.source));
    for (const tool of ["hand", "pour"] as const) {
      on(tool, () => {
        this.pointer.tool = tool;
        for (const other of ["hand", "pour"]) element(other).classList.toggle("on", other === tool);
        this.canvas.classList.toggle("pouring", tool === "pour");
      });
    }
    element("hand").classList.add("on");
    element("panel").classList.toggle("folded", innerWidth <= 640);
    on("record", () => this.send({ kind: this.status?.recorded ? "end_recording" : "record" }));
    on("save", () => this.send({ kind: "save" }));
    on("fold", () => element("panel").classList.toggle("folded"));
    on("open", () => element("file").click());
    element<HTMLInputElement>("particles").onchange = (event) => {
      this.drawing.showsParticles = (event.target as HTMLInputElement).checked;
      this.isStale = true;
    };
  }

  private files(): void {
    const open = async (file: File | undefined): Promise<void> => {
      if (!file) return;
      this.isRunning = true;
      this.load({ kind: "open", name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), isRunning: true });
    };
    const input = element<HTMLInputElement>("file");
    input.onchange = () => void open(input.files?.[0]).then(() => (input.value = ""));
    const drop = (event: DragEvent): void => {
      event.preventDefault();
      document.body.classList.toggle("dropping", event.type === "dragover");
      if (event.type === "drop") void open(event.dataTransfer?.files[0]);
    };
    for (const kind of ["dragover", "dragleave", "drop"] as const) document.addEventListener(kind, drop);
  }

  private showStatus(status: Status, timing: Timing): void {
    element("play").textContent = this.isRunning ? "Pause" : "Play";
    const record = element("record");
    record.textContent = status.recorded ? "Stop" : "Record";
    record.classList.toggle("on", status.recorded);
    (record as HTMLButtonElement).disabled = status.playing !== null;
    (element("step") as HTMLButtonElement).disabled = status.playing !== null;
    if (timing.steps > 0) this.stepTimes = [...this.stepTimes.slice(-29), timing.frame / timing.steps];
    const mean = this.stepTimes.reduce((sum, time) => sum + time, 0) / Math.max(this.stepTimes.length, 1);
    const figures: [string, string, string?][] = [
      ["Time", `${status.time.toFixed(2)} s`],
      ["Time of a step", this.stepTimes.length > 0 ? `${digits(mean)} ms` : "–"],
      ["Steps a frame", timing.steps > 0 ? String(timing.steps) : "–"],
      ["Particles", String(status.particles)],
      ["Water in sponges", `${digits(1000 * status.absorbed * status.particle_mass)} g`],
      ["Digest", status.digest, "code"],
    ];
    if (status.playing) figures.unshift(["Recording", `frame ${status.playing[0]} of ${status.playing[1]}`]);
    const cells = figures.flatMap(([name, value, kind]) => {
      const [term, text] = [document.createElement("dt"), document.createElement("dd")];
      term.textContent = name;
      text.textContent = value;
      if (kind) text.className = kind;
      return [term, text];
    });
    element("figures").replaceChildren(...cells);
  }
}

function download(name: string, bytes: Uint8Array<ArrayBuffer>): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

try {
  if (!hasSimd()) {
    throw new Error("This page needs WebAssembly with simd128, which this browser lacks. Chrome 91, Firefox 89 and Safari 16.4 have it.");
  }
  Object.assign(globalThis, { page: new Page() });
} catch (error) {
  tell(error instanceof Error ? error.message : String(error), true);
  element("panel").hidden = true;
  element("hint").hidden = true;
}
