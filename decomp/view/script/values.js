// The legend, and for a field its histogram and the range of values that is shown.

import { body, data, get, made, said } from "decomp/data";
import { chosen, chosenField, kinds, regionChip } from "decomp/colours";
import { elementValues, threshold } from "decomp/elements";

const BINS = 48, WIDE = 300, HIGH = 64;
let values = new Float32Array(0), changed = () => {};

export function onThreshold(act) { changed = act; }

/** A square of a colour. */
export function chip(colour) {
  const square = made("span", { className: "chip" });
  square.style.background = colour;
  return square;
}

/** What colours mean, and the range for a field; a range that was of another field is gone. */
export function legend() {
  const field = chosenField(), box = get("legend");
  if (threshold.field !== field) {
    Object.assign(threshold, { field, least: -Infinity, most: Infinity });
    get("least").value = 0;
    get("most").value = 1;
    values = field ? elementValues(field) : values;
  }
  get("range").hidden = !field;
  box.replaceChildren();
  if (field) {
    const bar = made("div", { id: "bar" });
    bar.style.background = `linear-gradient(to right, ${data.scale.join(",")})`;
    const ends = [field.least, field.most].map(value => made("span", { textContent: said(value) }));
    box.append(bar, made("div", { className: "ends" }, ...ends));
    histogram();
  } else if (chosen() === "kind") {
    kinds.forEach((kind, k) => box.append(made("div", { className: "key" }, chip(data.palette[k % data.categories]), kind)));
  } else if (chosen() === "region") {
    for (const { name } of data.regions) box.append(made("div", { className: "key" }, chip(regionChip(name)), name));
  }
}

const share = value => (value - threshold.field.least) / (threshold.field.most - threshold.field.least);
const bin = value => Math.min(BINS - 1, Math.max(0, Math.floor(BINS * share(value))));

function histogram() {
  const counts = new Array(BINS).fill(0);
  let inside = 0;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    counts[bin(value)]++;
    if (value >= threshold.least && value <= threshold.most) inside++;
  }
  const most = Math.max(...counts), { field } = threshold, box = get("histogram");
  box.setAttribute("viewBox", `0 0 ${WIDE} ${HIGH}`);
  box.setAttribute("preserveAspectRatio", "none");
  box.replaceChildren(...counts.map((count, k) => {
    const bar = document.createElementNS("http://www.w3.org/2000/svg", "rect");
    const [from, to] = [k, k + 1].map(edge => field.least + edge / BINS * (field.most - field.least));
    // a few elements among many are seen all the same
    const height = count && Math.max(2, count / most * HIGH);
    const sizes = { x: k * WIDE / BINS, y: HIGH - height, width: WIDE / BINS - 1, height };
    for (const [name, value] of Object.entries(sizes)) bar.setAttribute(name, value);
    bar.setAttribute("fill", to >= threshold.least && from <= threshold.most ? data.palette[0] : "#c8c8c8");
    const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
    title.textContent = `${said(from)} to ${said(to)}: ${count}`;
    bar.append(title);
    return bar;
  }));
  get("counted").textContent = `${inside} of ${values.length} ${body ? "tetrahedra" : "triangles"}`;
  get("least-said").textContent = said(Math.max(field.least, threshold.least));
  get("most-said").textContent = said(Math.min(field.most, threshold.most));
}

/** Show values between two shares of the field's range. */
function restrict(from, to) {
  const { field } = threshold, at = t => field.least + t * (field.most - field.least);
  get("least").value = from;
  get("most").value = to;
  threshold.least = from <= 0 ? -Infinity : at(from);
  threshold.most = to >= 1 ? Infinity : at(to);
  histogram();
  changed();
}

get("least").addEventListener("input", () => restrict(get("least").valueAsNumber, Math.max(get("least").valueAsNumber, get("most").valueAsNumber)));
get("most").addEventListener("input", () => restrict(Math.min(get("least").valueAsNumber, get("most").valueAsNumber), get("most").valueAsNumber));
get("whole-range").addEventListener("click", () => restrict(0, 1));

// drag across the histogram to show what lies under it
let start = null;
function under(event) {
  const box = get("histogram").getBoundingClientRect();
  return Math.min(BINS - 1, Math.max(0, Math.floor(BINS * (event.clientX - box.left) / box.width)));
}
get("histogram").addEventListener("pointerdown", event => {
  start = under(event);
  get("histogram").setPointerCapture(event.pointerId);
  restrict(start / BINS, (start + 1) / BINS);
});
get("histogram").addEventListener("pointermove", event => {
  if (start === null) return;
  const ends = [start, under(event)];
  restrict(Math.min(...ends) / BINS, (Math.max(...ends) + 1) / BINS);
});
for (const end of ["pointerup", "pointercancel"]) get("histogram").addEventListener(end, () => { start = null; });
