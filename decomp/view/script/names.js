// The list of names: by group and region, with search, "only this", and how opaque a group is.

import { data, get, made } from "decomp/data";
import { chip as colourOf, regionChip } from "decomp/colours";
import { chip } from "decomp/values";
import { opacity, pieces } from "decomp/parts";

const areRegions = data.parts.every(part => part.group !== "cell" || part.name === part.region);
const TITLES = { cell: areRegions ? "Volumes" : "Cells", sheet: "Sheets", interface: "Interfaces", face: "Faces" };
const MANY = 20; // names are folded under their regions if there are more
const groups = [], rows = [];
let changed = () => {}, before = null;

export function onNames(act) { changed = act; }

/** Show and hide parts; ticks and chips follow. */
function show(some, whether) {
  for (const piece of some) piece.mesh.visible = whether;
  refresh();
  changed();
}

/** Show some parts alone; "back to all" undoes it. */
function alone(some) {
  before ??= pieces.map(piece => piece.visible);
  get("back").hidden = false;
  for (const piece of pieces) piece.mesh.visible = false;
  show(some, true);
}

/** Show the part of a name alone, of this group if several have it, or all volumes of a region. Tells whether there is one. */
export function only(name, group = null) {
  const named = pieces.filter(piece => piece.name === name);
  const one = named.find(piece => piece.group === group) ?? named[0];
  const chosen = one ? [one] : pieces.filter(piece => piece.region === name && piece.group === data.first);
  if (chosen.length) alone(chosen);
  return chosen.length > 0;
}
get("back").addEventListener("click", () => {
  before.forEach((visible, k) => { pieces[k].mesh.visible = visible; });
  before = null;
  get("back").hidden = true;
  refresh();
  changed();
});

function box(title, own, open, more = {}) {
  const tick = made("input", { type: "checkbox", ...more });
  tick.addEventListener("click", event => event.stopPropagation());
  const sign = chip("transparent"), count = made("span");
  tick.addEventListener("change", () => show(found(own), tick.checked));
  const head = made("summary", {}, tick, " ", sign, ` ${title} `, count);
  const element = made("details", { open }, head);
  groups.push({ element, tick, own, count, sign, title });
  return element;
}

const isFound = piece => !pattern || pattern.test(piece.name);
const found = some => some.filter(isFound);
let pattern = null;

function item(piece, label) {
  const tick = made("input", { type: "checkbox" }), sign = chip("transparent");
  tick.addEventListener("change", () => show([piece], tick.checked));
  const button = made("button", { type: "button", textContent: "only", title: "show this one alone", onclick: () => alone([piece]) });
  const row = made("div", { className: "item", title: piece.name }, made("label", {}, tick, sign, made("span", { textContent: label })), button);
  rows.push({ row, tick, sign, piece });
  return row;
}

function glass(group) {
  const slider = made("input", { type: "range", min: 0.05, max: 1, step: 0.05, id: `opacity-${group}` });
  slider.value = opacity[group];
  slider.addEventListener("input", () => {
    opacity[group] = slider.valueAsNumber;
    for (const piece of pieces) if (piece.group === group) piece.showOpacity();
    changed();
  });
  return made("label", { className: "row glass" }, "opacity", slider);
}

export function list() {
  for (const group of Object.keys(TITLES)) {
    const own = pieces.filter(piece => piece.group === group);
    if (!own.length) continue;
    const isFirst = group === data.first;
    for (const piece of own) piece.mesh.visible = isFirst || opacity[group] < 1;
    const all = box(TITLES[group], own, isFirst, { id: `all-${group}` });
    all.append(glass(group));
    const regions = [...new Set(own.map(piece => piece.region))];
    for (const region of regions) {
      const inside = own.filter(piece => piece.region === region);
      // a region that is one volume needs no heading of its own
      const flat = regions.length === 1 || (inside.length === 1 && inside[0].name === region);
      const place = flat ? all : box(region || "no region", inside, own.length <= MANY, { name: region });
      if (!flat) all.append(place);
      const cut = (flat && regions.length > 1) || !inside.every(piece => piece.name.startsWith(`${region}/`)) ? 0 : region.length + 1;
      place.append(...inside.map(piece => item(piece, piece.name.slice(cut))));
    }
    get("names").append(all);
  }
  refresh();
}

/** Ticks, counts and chips as things are. */
export function refresh() {
  for (const { element, tick, own, count, sign } of groups) {
    const some = found(own), shown = some.filter(piece => piece.visible).length;
    element.hidden = !some.length;
    tick.checked = some.length > 0 && shown === some.length;
    tick.indeterminate = shown > 0 && shown < some.length;
    count.textContent = shown === some.length || !shown ? `(${some.length})` : `(${shown} of ${some.length})`;
    const colour = new Set(own.map(piece => piece.region)).size === 1 && element.parentElement?.closest("details")
      ? regionChip(own[0].region) : null;
    sign.hidden = !colour;
    sign.style.background = colour ?? "";
  }
  for (const { row, tick, sign, piece } of rows) {
    const colour = colourOf(piece.part);
    row.hidden = !isFound(piece);
    tick.checked = piece.visible;
    sign.hidden = !colour;
    sign.style.background = colour ?? "";
  }
}

get("search").addEventListener("input", () => {
  const text = get("search").value.trim();
  const quoted = text.replace(/[.+^${}()|[\]\\]/g, "\\$&").replaceAll("*", ".*").replaceAll("?", ".");
  pattern = text ? new RegExp(/[*?]/.test(text) ? `^${quoted}$` : quoted, "i") : null;
  refresh();
  if (pattern) for (const { element, own } of groups) if (found(own).length) element.open = true;
});
