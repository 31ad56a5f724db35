// Scenes that one core steps fast enough to watch.

import basin from "../scenes/basin.toml";
import type { Load } from "./module";

export interface Choice {
  name: string;
  title: string;
  load: Load;
}

/** Those of the library at a resolution of a page, and those made for it. */
export const CHOICES: Choice[] = [
  { name: "basin", title: "Squeeze a sponge by hand", load: { scene: basin } },
  { name: "ball_drop", title: "A ball falls on a wet sponge", load: { scene: "ball_drop", resolution: 0.45 } },
  { name: "squish", title: "Two plates squeeze a sponge", load: { scene: "squish", resolution: 0.5 } },
  { name: "life", title: "Dropped, soaked, squeezed, let go", load: { scene: "life", resolution: 0.5 } },
  { name: "standing", title: "A dry sponge drinks", load: { scene: "standing", resolution: 0.6 } },
  { name: "dam_break", title: "A dam drags a sponge along", load: { scene: "dam_break", resolution: 0.6 } },
  { name: "bobbing", title: "Six bodies float or sink", load: { scene: "bobbing", resolution: 0.45 } },
];
