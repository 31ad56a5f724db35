// Bundles the page into dist, or with `tests` the tests into build.
import { copyFileSync, mkdirSync } from "node:fs";
import { build } from "esbuild";

const isTest = process.argv[2] === "tests";
const outdir = isTest ? "build" : "dist";
mkdirSync(outdir, { recursive: true });
await build({
  entryPoints: isTest
    ? ["tests/bits.ts", "tests/browser.ts"]
    : ["page/page.ts", "page/worker.ts", "page/surface_worker.ts", "page/style.css"],
  bundle: true,
  outdir,
  format: "esm",
  target: "es2022",
  platform: isTest ? "node" : "browser",
  packages: isTest ? "external" : "bundle",
  loader: { ".toml": "text" },
  minify: !isTest,
  logLevel: "warning",
});
if (!isTest) copyFileSync("page/index.html", "dist/index.html");
