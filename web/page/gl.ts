// WebGL2: programs, meshes and targets.

import type { Matrix } from "./vector";
import type { Vector } from "./module";

/** The page cannot draw here. */
export class NoGraphics extends Error {}

export function context(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
  if (!gl) throw new NoGraphics("This page draws with WebGL2, which this browser does not have or has switched off.");
  if (!gl.getExtension("EXT_color_buffer_float")) {
    throw new NoGraphics("This page draws into textures of floats (EXT_color_buffer_float), which this graphics card does not have.");
  }
  gl.getExtension("OES_texture_float_linear");
  return gl;
}

type Value = number | Vector | [number, number] | Matrix | Texture;

const HEAD = `#version 300 es
precision highp float;
precision highp sampler3D;
precision highp sampler2DShadow;
`;

/** A texture at its unit. */
export interface Texture {
  texture: WebGLTexture;
  target: number;
}

export class Program {
  private readonly program: WebGLProgram;
  private readonly places = new Map<string, WebGLUniformLocation | null>();

  constructor(
    private readonly gl: WebGL2RenderingContext,
    vertex: string,
    fragment: string,
  ) {
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, HEAD + text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
        throw new Error(`a shader does not compile: ${gl.getShaderInfoLog(shader)}`);
      }
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(`shaders do not link: ${gl.getProgramInfoLog(program)}`);
    }
    this.program = program;
  }

  use(values: Record<string, Value>): void {
    const { gl } = this;
    gl.useProgram(this.program);
    let unit = 0;
    for (const [name, value] of Object.entries(values)) {
      const place = this.place(name);
      if (typeof value === "number") gl.uniform1f(place, value);
      else if (value instanceof Float32Array) gl.uniformMatrix4fv(place, false, value);
      else if (Array.isArray(value)) value.length === 2 ? gl.uniform2fv(place, value) : gl.uniform3fv(place, value);
      else {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(value.target, value.texture);
        gl.uniform1i(place, unit++);
      }
    }
  }

  private place(name: string): WebGLUniformLocation | null {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name)!;
  }
}

/** Vertices of floats, in attributes of some lengths at places 0, 1, ...; triangles by index. */
export class Mesh {
  private readonly array: WebGLVertexArrayObject;
  private readonly vertices: WebGLBuffer;
  private readonly indices: WebGLBuffer;
  private count = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    attributes: number[],
  ) {
    this.array = gl.createVertexArray();
    this.vertices = gl.createBuffer();
    this.indices = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    const stride = 4 * attributes.reduce((sum, length) => sum + length, 0);
    let offset = 0;
    attributes.forEach((length, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, length, gl.FLOAT, false, stride, offset);
      offset += 4 * length;
    });
    gl.bindVertexArray(null);
  }

  fill(vertices: Float32Array, indices: Uint32Array): this {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.DYNAMIC_DRAW);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(null);
    this.count = indices.length;
    return this;
  }

  draw(instances = 1): void {
    if (this.count === 0) return;
    this.gl.bindVertexArray(this.array);
    this.gl.drawElementsInstanced(this.gl.TRIANGLES, this.count, this.gl.UNSIGNED_INT, 0, instances);
  }

  /** A buffer of an attribute that instances have. */
  instances(place: number, length: number): WebGLBuffer {
    const { gl } = this;
    const buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, length, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(place, 1);
    gl.bindVertexArray(null);
    return buffer;
  }

  get isEmpty(): boolean {
    return this.count === 0;
  }
}

type Format = "light" | "thickness" | "display" | "depth";

function texture(gl: WebGL2RenderingContext, format: Format, width: number, height: number, isShadow: boolean): Texture {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  const inner = { light: gl.RGBA16F, thickness: gl.RG16F, display: gl.RGBA8, depth: gl.DEPTH_COMPONENT24 }[format];
  gl.texStorage2D(gl.TEXTURE_2D, 1, inner, width, height);
  const filter = format === "depth" && !isShadow ? gl.NEAREST : gl.LINEAR;
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  if (isShadow) gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  return { texture, target: gl.TEXTURE_2D };
}

/** Where something is drawn: a colour texture, a depth texture, or both. */
export class Target {
  readonly colour: Texture | null;
  readonly depth: Texture | null;
  private readonly buffer: WebGLFramebuffer;
  /** The same without the depth, which may then be read. */
  private readonly colourAlone: WebGLFramebuffer | null;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    readonly width: number,
    readonly height: number,
    colour: Exclude<Format, "depth"> | null,
    depth: "none" | "own" | "shadow" | Texture,
  ) {
    this.colour = colour ? texture(gl, colour, width, height, false) : null;
    const isOwn = typeof depth === "string";
    this.depth = depth === "none" ? null : isOwn ? texture(gl, "depth", width, height, depth === "shadow") : depth;
    this.buffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    if (this.colour) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.colour.texture, 0);
    else gl.drawBuffers([gl.NONE]);
    if (this.depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth.texture, 0);
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE && !gl.isContextLost()) {
      throw new NoGraphics("This graphics card cannot draw into the textures of this page.");
    }
    this.colourAlone = this.colour && !isOwn ? gl.createFramebuffer() : null;
    if (!this.colourAlone) return;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.colourAlone);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.colour!.texture, 0);
  }

  bindColour(): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.colourAlone);
    this.gl.viewport(0, 0, this.width, this.height);
  }

  bind(): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.buffer);
    this.gl.viewport(0, 0, this.width, this.height);
  }

  /** Frees its textures; a depth that another target owns stays. */
  free(isDepthOwn: boolean): void {
    if (this.colour) this.gl.deleteTexture(this.colour.texture);
    if (this.depth && isDepthOwn) this.gl.deleteTexture(this.depth.texture);
    this.gl.deleteFramebuffer(this.buffer);
    if (this.colourAlone) this.gl.deleteFramebuffer(this.colourAlone);
  }
}
