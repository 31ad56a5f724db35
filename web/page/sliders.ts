// Sliders of quantities, with the unit, the range and the description of the scene schema.

import type { Description, Vector } from "./module";

interface Key {
  minimum?: number;
  maximum?: number;
  description?: string;
  "x-unit"?: string;
}

interface Schema {
  $defs: Record<string, { properties?: Record<string, Key> }>;
}

interface Slider {
  label: string;
  /** Definition and key in the schema. */
  at: [string, string];
  /** Value in a scene; none if it has none. */
  value(description: Description): number | null;
  /** Shares of the value to which it reaches, or its ends. */
  reach: { times: number } | { from: number; to: number };
  /** The command that sets it, or the change of the scene that is built anew. */
  set(value: number, description: Description): { command: unknown } | { change: string };
}

const material = (label: string, key: string, times: number): Slider => ({
  label,
  at: ["Sponge", key],
  value: (description) => description.materials[0]?.[key] ?? null,
  reach: { times },
  set: (value, description) => {
    description.materials.forEach((own) => (own[key] = value));
    return { command: { material: { sponge: 0, material: description.materials[0] } } };
  },
});

const SLIDERS: Slider[] = [
  material("Young's modulus", "young_modulus", 10),
  material("Permeability", "permeability", 100),
  material("Capillary pressure", "entry_pressure", 4),
  {
    label: "Gravity",
    at: ["Scene", "gravity"],
    value: (description) => -description.gravity[1],
    reach: { from: 0, to: 20 },
    set: (value) => ({ command: { gravity: { gravity: [0, -value, 0] satisfies Vector } } }),
  },
  {
    label: "Viscosity of the water",
    at: ["Fluid", "viscosity"],
    value: (description) => description.viscosity,
    reach: { times: 1000 },
    set: (value) => ({ change: `fluid.viscosity=${value}` }),
  },
];

const STEPS = 200;

/** Three digits. */
export function digits(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 0.01 && size < 1e5 ? String(Number(value.toPrecision(3))) : value.toExponential(1);
}

export function showSliders(
  into: HTMLElement,
  schema: unknown,
  description: Description,
  act: (what: { command: unknown } | { change: string }) => void,
): void {
  into.replaceChildren();
  for (const slider of SLIDERS) {
    const value = slider.value(description);
    if (value === null || (value <= 0 && "times" in slider.reach)) continue;
    const key = keyOf(schema as Schema, slider.at);
    into.append(row(slider, key, value, (chosen) => act(slider.set(chosen, description))));
  }
}

function keyOf(schema: Schema, [definition, name]: [string, string]): Key {
  const properties = schema.$defs[definition]?.properties ?? (schema as unknown as { properties: Record<string, Key> }).properties;
  const key = properties[name] ?? {};
  // A vector has its unit and range with its elements.
  return { ...(key as { items?: Key }).items, ...key };
}

function row(slider: Slider, key: Key, value: number, act: (value: number) => void): HTMLElement {
  const { reach } = slider;
  const isByFactor = "times" in reach;
  const low = Math.max(isByFactor ? value / reach.times : reach.from, key.minimum ?? -Infinity);
  const high = Math.min(isByFactor ? value * reach.times : reach.to, key.maximum ?? Infinity);
  const valueAt = (share: number): number => (isByFactor ? low * (high / low) ** share : low + (high - low) * share);
  const shareOf = (own: number): number => (isByFactor ? Math.log(own / low) / Math.log(high / low) : (own - low) / (high - low));
  const label = document.createElement("label");
  label.title = (key.description ?? "").split("\n\n")[0]!;
  const name = document.createElement("span");
  const shown = document.createElement("output");
  const input = document.createElement("input");
  name.textContent = slider.label;
  Object.assign(input, { type: "range", min: "0", max: String(STEPS), value: String(Math.round(shareOf(value) * STEPS)) });
  const unit = key["x-unit"] === "1" ? "" : (key["x-unit"] ?? "");
  const show = (own: number): void => {
    shown.textContent = `${digits(own)} ${unit.replace("^2", "²").replace("^3", "³")}`;
  };
  show(value);
  input.oninput = () => show(valueAt(Number(input.value) / STEPS));
  input.onchange = () => act(Number(valueAt(Number(input.value) / STEPS).toPrecision(4)));
  label.append(name, shown, input);
  return label;
}
