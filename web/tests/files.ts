// Where things are, for tests, and the native program.

import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Module } from "../page/module";

export const WEB = join(dirname(fileURLToPath(import.meta.url)), "..");
export const DIST = join(WEB, "dist");
export const SCRATCH = mkdtempSync(join(tmpdir(), "sorb-web-"));

/** The native program: that of SORB, or of a build of the workspace. */
function program(): string {
  const target = process.env["CARGO_TARGET_DIR"] ?? join(WEB, "..", "target");
  const places = [process.env["SORB"], join(target, "release", "sorb"), join(target, "debug", "sorb")];
  const found = places.find((path) => path && existsSync(path));
  if (!found) throw new Error("the native program is not built: cargo build -p sorb-cli, or SORB=PATH");
  return found;
}

/** Runs the native program; what it prints, and whether it succeeded. */
export function native(...args: string[]): { text: string; isDone: boolean } {
  const sorb = program();
  try {
    return { text: execFileSync(sorb, args, { encoding: "utf8", cwd: SCRATCH, stdio: "pipe" }), isDone: true };
  } catch (error) {
    const { stdout, stderr } = error as { stdout?: string; stderr?: string };
    return { text: `${stdout ?? ""}${stderr ?? String(error)}`, isDone: false };
  }
}

export function module(): Promise<Module> {
  return Module.of(readFileSync(join(DIST, "sorb.wasm")));
}

export function check(isTrue: boolean, what: string): void {
  if (!isTrue) throw new Error(what);
}
