// Draws a state: what is solid, the water on it, glass, and the picture of all.

import { RANGE, type View } from "./camera";
import { context, Mesh, Program, Target, type Texture } from "./gl";
import type { Frame, Stage, Surface } from "./messages";
import type { BodyDescription, Vector } from "./module";
import * as shaders from "./shaders";
import * as waterShaders from "./shaders_water";
import { cuboid, shapeMesh } from "./shapes";
import { pores, Skin } from "./skin";
import { lookAt, type Matrix, middle, minus, length, orthographic, plus, pose, product, times, unit } from "./vector";

const SUN: Vector = unit([-0.5, 0.82, 0.3]);
const SHADOWS = 1024;
const CAUSTICS = 512;
/** Colours of bodies without one, by their place in the list; linear. */
const COLOURS: Vector[] = [[0.62, 0.07, 0.06], [0.05, 0.20, 0.55], [0.75, 0.42, 0.04], [0.06, 0.36, 0.16], [0.35, 0.35, 0.37]];
const GLASS: Vector = [0.62, 0.72, 0.76];

/** What all that is lit depends on. */
type Light = { eye: Vector; sun: Vector; shadow_view: Matrix; shadow: Texture };

interface Drawn {
  mesh: Mesh;
  scale: Vector;
  description: BodyDescription;
  colour: Vector;
  number: number;
}

/** Targets of the size of the picture. */
class Targets {
  readonly solid: Target;
  /** The floor alone, and the backs of what stands on it: what rays meet that are bent. */
  readonly ground: Target;
  readonly backs: Target;
  readonly water: Target;
  readonly thickness: Target;
  readonly lit: Target;
  readonly display: Target;

  constructor(gl: WebGL2RenderingContext, width: number, height: number) {
    this.solid = new Target(gl, width, height, "light", "own");
    this.ground = new Target(gl, width, height, "light", "none");
    this.backs = new Target(gl, width, height, null, "own");
    this.water = new Target(gl, width, height, "light", "own");
    this.thickness = new Target(gl, width, height, "thickness", "none");
    this.lit = new Target(gl, width, height, "light", this.solid.depth!);
    this.display = new Target(gl, width, height, "display", "none");
  }

  free(): void {
    for (const target of [this.solid, this.ground, this.backs, this.water, this.thickness, this.display]) target.free(true);
    this.lit.free(false);
  }
}

export class Drawing {
  showsParticles = false;
  private readonly gl: WebGL2RenderingContext;
  private readonly programs: Record<
    "solid" | "shadow" | "skinShadow" | "skin" | "glass" | "floor" | "ball" | "caustics" | "water" | "thickness"
    | "composite" | "display" | "edges",
    Program
  >;
  private readonly shadows: Target;
  private readonly caustics: Target;
  private readonly cube: Mesh;
  private readonly square: Mesh;
  private readonly balls: Mesh;
  private readonly particles: WebGLBuffer;
  private readonly skinMesh: Mesh;
  private readonly waterMesh: Mesh;
  private readonly pores: Texture;
  private targets: Targets | null = null;
  private stage: Stage | null = null;
  private skin: Skin | null = null;
  private bodies: Drawn[] = [];
  private frame: Frame | null = null;
  /** Middle of the floor, and how far the scene reaches from there (m). */
  private middle: Vector = [0, 0, 0];
  private reach = 0.2;
  /** Half the size of the container along x and z (m). */
  private halfSize: [number, number] = [0, 0];

  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = context(canvas);
    this.gl = gl;
    const solid = shaders.SOLID_VERTEX;
    const screen = waterShaders.SCREEN_VERTEX;
    this.programs = {
      solid: new Program(gl, solid, shaders.BODY_FRAGMENT),
      shadow: new Program(gl, solid, shaders.SHADOW_FRAGMENT),
      skinShadow: new Program(gl, shaders.SKIN_VERTEX, shaders.SHADOW_FRAGMENT),
      skin: new Program(gl, shaders.SKIN_VERTEX, shaders.SKIN_FRAGMENT),
      glass: new Program(gl, solid, shaders.GLASS_FRAGMENT),
      floor: new Program(gl, shaders.FLOOR_VERTEX, shaders.FLOOR_FRAGMENT),
      caustics: new Program(gl, waterShaders.CAUSTICS_VERTEX, waterShaders.CAUSTICS_FRAGMENT),
      water: new Program(gl, waterShaders.WATER_VERTEX, waterShaders.WATER_FRAGMENT),
      thickness: new Program(gl, waterShaders.WATER_VERTEX, waterShaders.THICKNESS_FRAGMENT),
      composite: new Program(gl, screen, waterShaders.COMPOSITE_FRAGMENT),
      display: new Program(gl, screen, shaders.DISPLAY_FRAGMENT),
      edges: new Program(gl, screen, shaders.EDGES_FRAGMENT),
      ball: new Program(gl, shaders.BALL_VERTEX, shaders.BALL_FRAGMENT),
    };
    this.shadows = new Target(gl, SHADOWS, SHADOWS, null, "shadow");
    this.caustics = new Target(gl, CAUSTICS, CAUSTICS, "light", "none");
    this.cube = cuboid(gl);
    const corners = new Float32Array([-1, -1, -1, 0, 0, 1, 1, -1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1, -1, 1, -1, 0, 0, 1]);
    this.square = new Mesh(gl, [3, 3]).fill(corners, new Uint32Array([0, 1, 2, 0, 2, 3]));
    this.balls = new Mesh(gl, [3, 3]).fill(corners, new Uint32Array([0, 1, 2, 0, 2, 3]));
    this.particles = this.balls.instances(2, 4);
    this.skinMesh = new Mesh(gl, [3, 3, 3, 1]);
    this.waterMesh = new Mesh(gl, [3, 3]);
    this.pores = { texture: pores(gl), target: gl.TEXTURE_3D };
  }

  begin(stage: Stage): void {
    this.stage = stage;
    this.skin = new Skin(stage);
    this.bodies = stage.description.bodies.flatMap((description, number) => {
      const found = description.removed ? null : shapeMesh(this.gl, description.shape);
      const colour = description.colour ?? COLOURS[number % COLOURS.length]!;
      return found ? [{ ...found, description, colour, number }] : [];
    });
    const [low, high] = stage.description.container ?? [[-0.15, 0, -0.15], [0.15, 0.3, 0.15]];
    const centre = middle(low as Vector, high as Vector);
    this.middle = [centre[0], low[1]!, centre[2]];
    this.reach = 0.62 * Math.max(high[0]! - low[0]!, high[2]! - low[2]!) + 0.4 * Math.min(high[1]! - low[1]!, 0.2);
    this.halfSize = [0.5 * (high[0]! - low[0]!), 0.5 * (high[2]! - low[2]!)];
    this.skinMesh.fill(new Float32Array(0), new Uint32Array(0));
    this.waterMesh.fill(new Float32Array(0), new Uint32Array(0));
  }

  /** Takes a state and the surface of its water. */
  show(frame: Frame, surface: Surface): void {
    const { gl } = this;
    this.frame = frame;
    if (this.skin && !this.skin.isEmpty) this.skinMesh.fill(this.skin.vertices(frame), this.skin.indices);
    this.waterMesh.fill(surface.vertices, surface.indices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.particles);
    gl.bufferData(gl.ARRAY_BUFFER, frame.particles, gl.DYNAMIC_DRAW);
  }

  draw(view: View): void {
    const { gl, canvas, frame, stage } = this;
    if (!frame || !stage) return;
    if (this.targets?.solid.width !== canvas.width || this.targets.solid.height !== canvas.height) {
      this.targets?.free();
      this.targets = new Targets(gl, canvas.width, canvas.height);
    }
    const targets = this.targets;
    const shadowView = this.drawShadows();
    this.drawCaustics();
    const light = { eye: view.eye, sun: SUN, shadow_view: shadowView, shadow: this.shadows.depth! };
    gl.clearColor(0.84, 0.87, 0.9, 1);
    targets.ground.bind();
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.drawFloor(view, light);
    gl.enable(gl.DEPTH_TEST);
    targets.solid.bind();
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawFloor(view, light);
    this.drawSolids(view, light);
    targets.backs.bind();
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.FRONT);
    this.drawDepths(view.matrix);
    gl.disable(gl.CULL_FACE);
    targets.solid.bind();
    this.drawEdges(view, false);
    this.drawWater(view, targets);
    this.drawGlass(view);
    this.drawEdges(view, true);
    gl.disable(gl.DEPTH_TEST);
    targets.display.bind();
    this.programs.display.use({ light: targets.lit.colour! });
    this.square.draw();
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    this.programs.edges.use({ picture: targets.display.colour! });
    this.square.draw();
  }

  /** Depths as the sun sees them; the matrix of that view. */
  private drawShadows(): Matrix {
    const { gl, middle: floor } = this;
    const far = 1.5;
    const centre = plus(floor, [0, 0.35 * this.reach, 0]);
    const view = product(orthographic(1.35 * this.reach, 0.1, 2 * far), lookAt(plus(centre, times(SUN, far)), centre, [0, 0, 1]));
    this.shadows.bind();
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawDepths(view);
    return view;
  }

  /** Depths of what is solid, without the floor. */
  private drawDepths(view: Matrix): void {
    this.programs.skinShadow.use({ view });
    this.skinMesh.draw();
    for (const body of this.bodies) {
      if (isGlass(body)) continue;
      this.programs.shadow.use({ view, model: this.model(body) });
      body.mesh.draw();
    }
  }

  /** What the water does with the light on the floor. */
  private drawCaustics(): void {
    const { gl } = this;
    this.caustics.bind();
    gl.disable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (this.waterMesh.isEmpty || this.showsParticles) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    for (const is_bent of [0, 1]) {
      this.programs.caustics.use({ sun: SUN, middle: this.middle, reach: this.reach, is_bent });
      this.waterMesh.draw();
    }
    gl.disable(gl.BLEND);
  }

  private drawFloor(view: View, light: Light): void {
    const floor = { middle: this.middle, pitch: tilePitch(this.reach), reach: this.reach, half_size: this.halfSize };
    this.programs.floor.use({ ...light, ...floor, view: view.matrix, caustics: this.caustics.colour! });
    this.square.draw();
  }

  private drawSolids(view: View, light: Light): void {
    const { gl, frame } = this;
    const shared = { ...light, view: view.matrix };
    this.programs.skin.use({ ...shared, pores: this.pores });
    this.skinMesh.draw();
    for (const body of this.bodies) {
      if (isGlass(body)) continue;
      this.programs.solid.use({ ...shared, model: this.model(body), colour: body.colour });
      body.mesh.draw();
    }
    if (this.showsParticles) {
      const radius = 0.5 * (this.stage?.description.spacing ?? 0.005);
      this.programs.ball.use({ ...shared, right_unit: view.right, above_unit: view.above, forward: view.forward, radius });
      this.balls.draw((frame?.particles.length ?? 0) / 4);
    }
    gl.bindVertexArray(null);
  }

  private drawWater(view: View, targets: Targets): void {
    const { gl } = this;
    const size: [number, number] = [targets.solid.width, targets.solid.height];
    const depth = targets.solid.depth!;
    const shared = { eye: view.eye, view: view.matrix, forward: view.forward, depth, range: RANGE, size };
    const isShown = !this.waterMesh.isEmpty && !this.showsParticles;
    gl.clearColor(0, 0, 0, 0);
    targets.water.bind();
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (isShown) {
      this.programs.water.use(shared);
      this.waterMesh.draw();
    }
    gl.disable(gl.DEPTH_TEST);
    targets.thickness.bind();
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (isShown) {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);
      this.programs.thickness.use(shared);
      this.waterMesh.draw();
      gl.disable(gl.BLEND);
    }
    // The composite reads the depth that its target has.
    targets.lit.bindColour();
    this.programs.composite.use({
      ...shared,
      solid: targets.solid.colour!,
      water: targets.water.colour!,
      thickness: targets.thickness.colour!,
      sun: SUN,
      right: times(view.right, view.slope * view.aspect),
      above: times(view.above, view.slope),
      spacing: this.stage?.description.spacing ?? 0.005,
      reach: this.reach,
      floor_height: this.middle[1],
      ground: targets.ground.colour!,
      backs: targets.backs.depth!,
    });
    this.square.draw();
    targets.lit.bind();
    gl.enable(gl.DEPTH_TEST);
  }

  private drawGlass(view: View): void {
    const { gl } = this;
    const shells = this.bodies.filter(isGlass);
    if (shells.length === 0) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    for (const face of [gl.FRONT, gl.BACK]) {
      gl.cullFace(face);
      for (const body of shells) {
        const colour = body.description.colour ?? GLASS;
        this.programs.glass.use({ view: view.matrix, eye: view.eye, sun: SUN, model: this.model(body), colour, least: 0.1 });
        body.mesh.draw();
      }
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  /** Edges of the container: those behind the water before it, those in front after it. */
  private drawEdges(view: View, isFront: boolean): void {
    const { gl } = this;
    const container = this.stage?.description.container;
    if (!container) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    const [low, high] = container;
    const half = minus(times(high, 0.5), times(low, 0.5));
    const centre = middle(low, high);
    for (let axis = 0; axis < 3; axis++) {
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const) {
        const way: Vector = [0, 0, 0];
        way[(axis + 1) % 3] = u * half[(axis + 1) % 3]!;
        way[(axis + 2) % 3] = v * half[(axis + 2) % 3]!;
        const place = plus(centre, way);
        if (length(minus(place, view.eye)) < length(minus(centre, view.eye)) !== isFront) continue;
        // Half of a line of 1.3 pixels: thinner ones break into dots.
        const width = (1.3 * view.slope * length(minus(place, view.eye))) / this.canvas.height;
        const scale: Vector = [width, width, width];
        scale[axis] = half[axis]!;
        const model = pose(place, [0, 0, 0, 1], scale);
        this.programs.glass.use({ view: view.matrix, eye: view.eye, sun: SUN, model, colour: [0.5, 0.57, 0.6], least: 0.42 });
        this.cube.draw();
      }
    }
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  private model(body: Drawn): Matrix {
    const at = 8 * body.number;
    const row = this.frame!.bodies.subarray(at, at + 8);
    return pose([row[0]!, row[1]!, row[2]!], [row[4]!, row[5]!, row[6]!, row[7]!], body.scale);
  }
}

function isGlass(body: Drawn): boolean {
  const { look, kind } = body.description;
  return look === "glass" || (look === null && kind === "kinematic");
}

/** Edge of a tile: 1, 2 or 5 of a power of ten. */
function tilePitch(reach: number): number {
  const wanted = reach / 7;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * ([1, 2, 5, 10].find((step) => step * power >= wanted) ?? 10);
}
