// Colours of parts, of regions, of kinds of surfaces, and of values.

import * as THREE from "three";
import { data, fields } from "decomp/data";

const NONE = new THREE.Color("#c8c8c8");
const palette = data.palette.map(colour => new THREE.Color(colour));
const scale = data.scale.map(colour => new THREE.Color(colour));
const sheets = data.parts.filter(part => part.group === "sheet");
export const kinds = [...new Set(sheets.map(part => part.kind))];

/** The ways to colour, by what the list of them says. */
export const modes = { name: "name" };
if (!data.body && sheets.length) modes.kind = "kind of surface";
if (data.regions.length > 1) modes.region = "region";
fields.forEach((field, k) => {
  const finite = field.values.filter(Number.isFinite);
  field.least = finite.reduce((a, b) => Math.min(a, b), Infinity);
  field.most = finite.reduce((a, b) => Math.max(a, b), -Infinity);
  if (field.most > field.least) modes[`field-${k}`] = field.name;
});

let mode = modes.kind && kinds.length > 1 ? "kind" : modes.region && data.body ? "region" : "name";
export const chosen = () => mode;
export function choose(which) { mode = which; }
export const chosenField = () => mode.startsWith("field-") ? fields[Number(mode.slice(6))] : null;

/** The number of a part's colour in the palette, in a mode without values. */
function number(part) {
  if (mode === "kind" && part.group === "sheet") return kinds.indexOf(part.kind) % data.categories;
  if (mode === "region") return data.regions.find(region => region.name === part.region)?.colour;
  return part.colour;
}
export function chip(part) {
  const k = number(part);
  return chosenField() ? null : data.palette[k] ?? `#${NONE.getHexString()}`;
}
export const regionChip = name =>
  mode === "region" ? data.palette[data.regions.find(region => region.name === name)?.colour] : null;

const shade = new THREE.Color();
function onScale(share) {
  const x = Math.min(Math.max(share, 0), 1) * (scale.length - 1);
  const k = Math.min(Math.floor(x), scale.length - 2);
  return shade.copy(scale[k]).lerp(scale[k + 1], x - k);
}

/** The colour between nodes a and b of a part's element; `tet` is its tetrahedron, -1 for none. */
export function colourAt(part, tet, a, b, share) {
  const field = chosenField();
  if (!field) return palette[number(part)] ?? NONE;
  if (!field.at_points && tet < 0) return NONE;
  const value = field.at_points ? field.values[a] + share * (field.values[b] - field.values[a]) : field.values[tet];
  return Number.isFinite(value) ? onScale((value - field.least) / (field.most - field.least)) : NONE;
}
