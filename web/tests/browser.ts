// The page in headless Chromium: its bits, its picture, its hand. Pictures are left in the folder of PICTURES.

import { type ChildProcess, spawn } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type Browser, chromium, type Page } from "playwright-core";
import type { Status } from "../page/module";
import { check, module, native, SCRATCH, WEB } from "./files";

interface Shown {
  page: { frames(count: number): Promise<Status>; status: Status | null; making: unknown; next: unknown };
}

const FRAMES = 20;
const SIZE = { width: 1280, height: 720 };
const PICTURES = process.env["PICTURES"] ?? SCRATCH;
const EXECUTABLE = [process.env["CHROMIUM"], "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(
  (path) => path && existsSync(path),
);

/** Serves the page; the address, and what ends it. */
async function serve(): Promise<{ address: string; server: ChildProcess }> {
  const server = spawn(process.execPath, [join(WEB, "serve.mjs"), "0"], { stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise<string>((resolve, reject) => {
    server.stdout!.once("data", (text) => resolve(String(text).trim()));
    server.once("exit", (code) => reject(new Error(`the server has ended with ${code}`)));
  });
  return { address, server };
}

async function open(browser: Browser, address: string, query: string): Promise<{ page: Page; errors: string[] }> {
  const page = await browser.newPage({ viewport: SIZE });
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (line) => {
    // What the software renderer says about its own speed is no error of the page.
    if (line.type() === "error" || (line.type() === "warning" && !line.text().includes("GPU stall"))) errors.push(line.text());
  });
  await page.goto(`${address}?${query}`);
  await page.waitForFunction(() => (globalThis as unknown as Shown).page?.status != null, undefined, { timeout: 60_000 });
  return { page, errors };
}

const frames = (page: Page, count: number): Promise<Status> =>
  page.evaluate((count) => (globalThis as unknown as Shown).page.frames(count), count);

/** The picture, once the surface of the last state is drawn. */
async function picture(page: Page, name: string): Promise<Buffer> {
  await page.waitForFunction(() => {
    const { making, next } = (globalThis as unknown as Shown).page;
    return !making && !next;
  });
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const bytes = await page.screenshot();
  mkdirSync(PICTURES, { recursive: true });
  writeFileSync(join(PICTURES, `${name}.png`), bytes);
  return bytes;
}

/** The digest of the page is that of node and of the native program. */
async function sameBits(browser: Browser, address: string): Promise<void> {
  for (const [scene, resolution] of [["ball_drop", 0.45], ["squish", 0.5]] as const) {
    const { page, errors } = await open(browser, address, `paused&scene=${scene}`);
    const { digest } = await frames(page, FRAMES);
    const own = await module();
    own.load({ scene, resolution });
    for (let frame = 0; frame < FRAMES; frame++) own.frame();
    const file = join(SCRATCH, "native.rec");
    const recorded = native("record", scene, "--resolution", `${resolution}`, "--frames", `${FRAMES}`, "--out", file);
    check(recorded.text.includes(digest), `${scene}: Chromium has digest ${digest}, natively: ${recorded.text}`);
    check(own.digest() === digest, `${scene}: Chromium has digest ${digest}, node ${own.digest()}`);
    await picture(page, scene);
    // A dropped recording plays and is verified; a changed one is refused.
    const bytes = readFileSync(file);
    const input = page.locator("#file");
    await input.setInputFiles({ name: "native.rec", mimeType: "application/octet-stream", buffer: bytes });
    await page.locator("#message:not(.failure)", { hasText: `all ${FRAMES} frames` }).waitFor({ timeout: 120_000 });
    bytes[bytes.length - 9]! ^= 1;
    await input.setInputFiles({ name: "changed.rec", mimeType: "application/octet-stream", buffer: bytes });
    await page.locator("#message.failure").waitFor();
    const text = await page.locator("#message").textContent();
    check(errors.length === 0, errors.join("; "));
    await page.close();
    console.log(`${scene}: digest ${digest} in Chromium, node and natively; the native recording is verified; a changed byte: ${text}`);
  }
}

/** Dragging the sponge changes the picture and the state; without the hand the state is another one. */
async function hand(browser: Browser, address: string): Promise<void> {
  const { page, errors } = await open(browser, address, "paused&scene=basin");
  await frames(page, FRAMES);
  const before = await picture(page, "basin");
  const untouched = await frames(page, FRAMES);
  await page.locator("#reset").click();
  await page.waitForFunction(() => (globalThis as unknown as Shown).page.status?.frames === 0);
  await frames(page, FRAMES);
  const [x, y] = [0.40 * SIZE.width, 0.47 * SIZE.height];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.locator("#picture.holding").waitFor();
  await page.mouse.move(x + 60, y - 120, { steps: 4 });
  const dragged = await frames(page, FRAMES);
  check(dragged.digest !== untouched.digest && dragged.frames === untouched.frames, "the hand has changed nothing");
  const after = await picture(page, "basin_dragged");
  check(!after.equals(before), "the picture has not changed");
  await page.mouse.up();
  await page.locator("#pour").click();
  await page.mouse.move(0.62 * SIZE.width, 0.3 * SIZE.height);
  await page.mouse.down();
  const poured = await frames(page, FRAMES);
  check(poured.particles > dragged.particles, "no water was poured");
  await picture(page, "basin_poured");
  await page.mouse.up();
  check(errors.length === 0, errors.join("; "));
  await page.close();
  console.log(`basin: the sponge was dragged, ${poured.particles - dragged.particles} particles were poured`);
}

/** Without simd128 or WebGL2 the page says so. */
async function messages(browser: Browser, address: string): Promise<void> {
  const missing: [string, () => void][] = [
    ["simd128", () => (WebAssembly.validate = () => false)],
    ["WebGL2", () => (HTMLCanvasElement.prototype.getContext = () => null)],
  ];
  for (const [name, remove] of missing) {
    const page = await browser.newPage({ viewport: SIZE });
    await page.addInitScript(remove);
    await page.goto(address);
    await page.locator("#message.failure", { hasText: name }).waitFor();
    await page.close();
  }
}

/** Time of a step of the scenes of the page, as it shows it. */
async function times(browser: Browser, address: string, scenes: string[]): Promise<void> {
  for (const scene of scenes) {
    const { page, errors } = await open(browser, address, `paused&scene=${scene}`);
    const start = Date.now();
    const { steps, particles } = await frames(page, 60);
    console.log(`${scene}: ${particles} particles, ${steps} steps, ${((Date.now() - start) / steps).toFixed(2)} ms a step`);
    await picture(page, `${scene}_60`);
    check(errors.length === 0, errors.join("; "));
    await page.close();
  }
}

if (!EXECUTABLE) throw new Error("no Chromium: apt-get install chromium, or CHROMIUM=PATH");
const { address, server } = await serve();
const flags = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"];
const browser = await chromium.launch({ executablePath: EXECUTABLE, args: flags });
try {
  if (process.env["SCENES"]) {
    await times(browser, address, process.env["SCENES"].split(","));
  } else {
    await sameBits(browser, address);
    await hand(browser, address);
    await messages(browser, address);
    console.log("the page has the bits of the native program");
  }
} finally {
  await browser.close();
  server.kill();
  if (PICTURES !== SCRATCH) rmSync(SCRATCH, { recursive: true });
}
