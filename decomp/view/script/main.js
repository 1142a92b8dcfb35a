// The page put together: what each control changes.

import * as THREE from "three";
import { data, fields, get } from "decomp/data";
import { chosen, choose, modes } from "decomp/colours";
import { pieces } from "decomp/parts";
import { cap, isCut, kept, paintCaps, placeAll, section } from "decomp/section";
import { aim, draw, fit, look, nearSide } from "decomp/looking";
import { legend, onThreshold } from "decomp/values";
import { list, only as showOnly, onNames, refresh } from "decomp/names";
import { seenAt } from "decomp/pointing";

get("title").textContent = data.title;
for (const [mode, text] of Object.entries(modes)) get("colour").add(new Option(text, mode));
get("colour").value = chosen();
get("whole-row").hidden = !data.body;

let mask = null;

/** Other elements are shown: all surfaces are made anew when they are next seen. */
function elements() {
  mask = kept();
  for (const piece of pieces) piece.stale = true;
  visible();
}

/** Other parts are shown. */
function visible() {
  const edges = get("edges").checked;
  for (const piece of pieces) {
    if (piece.visible && piece.stale) piece.build(mask);
    piece.lines.visible = edges;
  }
  cap(mask, edges);
  draw();
}

/** The plane or the parts have moved. */
function moved() {
  placeAll();
  if (section.whole) elements();
  else visible();
}

function colours() {
  choose(get("colour").value);
  const was = mask;
  legend();
  mask = kept();
  if (was || mask) elements();
  else for (const piece of pieces) if (!piece.stale) piece.paint();
  paintCaps();
  refresh();
  draw();
}

get("colour").addEventListener("change", colours);
get("slice").addEventListener("input", () => {
  // a section begins on the side that the eye is on
  if (!isCut()) section.side = nearSide(section.axis);
  section.share = get("slice").valueAsNumber;
  moved();
});
get("axis").addEventListener("change", () => {
  section.axis = "xyz".indexOf(get("axis").value);
  section.side = nearSide(section.axis);
  moved();
});
get("flip").addEventListener("click", () => {
  if (!isCut()) section.side = nearSide(section.axis);
  // the plane stays where it is
  section.side = -section.side;
  section.share = 1 - section.share;
  get("slice").value = section.share;
  moved();
});
get("whole").addEventListener("change", () => {
  section.whole = get("whole").checked;
  placeAll();
  elements();
});
get("explode").addEventListener("input", () => {
  section.exploded = get("explode").valueAsNumber;
  moved();
  look();
});
get("edges").addEventListener("change", visible);
onThreshold(elements);
onNames(visible);
window.addEventListener("resize", fit);

list();
placeAll();
colours();
visible();
fit();

/** Show a part alone, and go near it. Tells whether there is one. */
function only(name, group) {
  if (!showOnly(name, group)) return false;
  const box = new THREE.Box3();
  for (const piece of pieces) if (piece.visible) box.union(new THREE.Box3().setFromObject(piece.mesh));
  aim(box);
  return true;
}

/** An address that ends in #only=NAME shows that part alone; &group=face tells one from a volume of its name. */
function follow() {
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.has("only")) only(asked.get("only"), asked.get("group"));
}
window.addEventListener("hashchange", follow);
follow();
window.decompView = { pieces, fields, only, seenAt };
