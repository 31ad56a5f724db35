// The module has the bits of the native program: digests, recordings and saves, in both directions.

import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Column, Refusal } from "../page/module";
import { check, module, native, SCRATCH } from "./files";

const SCENES = [
  { scene: "water", resolution: 0.5, frames: 30 },
  { scene: "ball_drop", resolution: 0.4, frames: 40 },
];

/** The text of a refusal; an error if nothing was refused. */
function refusal(act: () => unknown): string {
  try {
    act();
  } catch (error) {
    if (error instanceof Refusal) return error.message;
    throw error;
  }
  throw new Error("something was to be refused, and was not");
}

/** Digests after some frames, and a recording of the native program that the module verifies. */
async function digests(): Promise<void> {
  for (const { scene, resolution, frames } of SCENES) {
    const file = join(SCRATCH, `${scene}.rec`);
    const args = ["record", scene, "--resolution", `${resolution}`, "--frames", `${frames}`, "--every", "10", "--out", file];
    const recorded = native(...args);
    const expected = /digest ([0-9a-f]{16})/.exec(recorded.text)?.[1];
    check(recorded.isDone && expected !== undefined, recorded.text);
    const own = await module();
    const { simd } = own.load({ scene, resolution });
    for (let frame = 0; frame < frames; frame++) own.frame();
    const { digest, steps, particles } = own.status();
    check(simd === "simd128", `the module runs at ${simd}`);
    check(digest === expected && digest === own.digest(), `${scene}: digest ${digest} instead of ${expected}`);
    const bytes = readFileSync(file);
    check(own.verify(bytes) === frames, `${scene}: not all frames were verified`);
    console.log(`${scene}: ${particles} particles, ${steps} steps, digest ${digest} as natively; the native recording is verified`);
    // Controls: a changed byte, and a changed scene.
    bytes[bytes.length - 9]! ^= 1;
    const text = refusal(() => own.verify(bytes));
    console.log(`  a changed byte: ${text}`);
    own.load({ scene, resolution, set: ["gravity=[0, -9.81, 0.0001]"] });
    for (let frame = 0; frame < frames; frame++) own.frame();
    check(own.digest() !== expected, `${scene}: another scene has the same digest`);
  }
}

/** A recording of the module, with commands as a page sends them, verifies natively. */
async function recording(): Promise<void> {
  const own = await module();
  own.load({ scene: "ball_drop", resolution: 0.4 });
  for (let frame = 0; frame < 5; frame++) own.frame();
  own.record(10);
  const body = own.status().next_body;
  const shape = { kind: "sphere", radius: 0.001 };
  own.command({ add_body: { body, description: { name: "hand", kind: "kinematic", shape, position: [0, 1, 0] } } });
  own.command({ grip: { body, nodes: { sphere: { centre: [0.04, 0.05, 0.04], radius: 0.03 } } } });
  for (let frame = 1; frame <= 20; frame++) {
    own.command({ pose: { body, position: [0, 1 + 0.002 * frame, 0], rotation: [0, 0, 0, 1], duration: 1 / 60 } });
    if (frame === 8) own.command({ pour: { region: { sphere: { centre: [-0.05, 0.2, 0.05], radius: 0.02 } }, velocity: [0, -0.5, 0] } });
    own.frame();
  }
  own.step();
  const file = join(SCRATCH, "page.rec");
  const bytes = own.endRecording();
  writeFileSync(file, bytes);
  const replayed = native("replay", file, "--verify");
  check(replayed.isDone && replayed.text.includes(own.digest()), `the native program says: ${replayed.text}`);
  console.log(`a recording of the module, ${bytes.length} bytes: ${replayed.text.trim()}`);
  bytes[bytes.length >> 1]! ^= 1;
  writeFileSync(file, bytes);
  const changed = native("replay", file, "--verify");
  check(!changed.isDone, "a changed byte passed natively");
  console.log(`  a changed byte: ${changed.text.trim()}`);
}

/** A saved state continues with the same bits, in another module and natively. */
async function saves(): Promise<void> {
  const [first, second] = [await module(), await module()];
  first.load({ scene: "ball_drop", resolution: 0.4 });
  for (let frame = 0; frame < 10; frame++) first.frame();
  const save = first.save();
  const file = join(SCRATCH, "state.sorb");
  writeFileSync(file, save);
  second.restore(save);
  check(second.digest() === first.digest(), "a restored state has another digest");
  for (const own of [first, second]) for (let frame = 0; frame < 10; frame++) own.frame();
  check(second.digest() === first.digest(), "a restored state continues with other bits");
  check(first.floats(Column.particlePositions).length === 4 * first.status().particles, "not a row for every particle");
  const out = join(SCRATCH, "out");
  const continued = native("run", "--from", file, "--frames", "10", "--out", out);
  check(continued.isDone && continued.text.includes(first.digest()), `natively: ${continued.text}`);
  console.log(`a save of the module continues natively to digest ${first.digest()}`);
}

/** What is wrong is a text, and changes nothing. */
async function refusals(): Promise<void> {
  const own = await module();
  check(refusal(() => own.frame()) === "no scene is loaded", "a frame without a scene");
  check(refusal(() => own.load({ scene: "balldrop" })).includes("ball_drop"), "no near name for a scene");
  own.load({ scene: "ball_drop", resolution: 0.4 });
  const before = own.digest();
  check(refusal(() => own.command({ gravity: { gravity: [0, -1000, 0] } })).includes("-100 to 100"), "no range");
  check(refusal(() => own.load({ scene: "[fluid]\nspacing = 0.5\n" })).length > 0, "no text");
  check(refusal(() => own.restore(new Uint8Array(100))).length > 0, "no text");
  check(own.digest() === before, "a refusal has changed the state");
}

await refusals();
await digests();
await recording();
await saves();
rmSync(SCRATCH, { recursive: true });
console.log("all bits are the same");
