// Makes the surface of the water, beside the worker that steps and the page that draws.

import type { SurfaceRequest } from "./messages";
import { surface } from "./surface";

self.onmessage = (event: MessageEvent<SurfaceRequest>) => {
  const made = surface(event.data);
  (self as unknown as Worker).postMessage(made, [made.vertices.buffer, made.indices.buffer]);
};
