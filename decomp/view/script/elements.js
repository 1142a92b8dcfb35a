// Which elements are shown: the threshold on a field, and sections along whole elements.

import { body, data, fields, points } from "decomp/data";

/** The field that is coloured by, and the values that are shown; null for all. */
export const threshold = { field: null, least: -Infinity, most: Infinity };

const ON = 1e-6; // points nearer to a plane are on it; the whole is 2 across
const corner = (t, k) => body.tets[4 * t + k];

/** The value of a tetrahedron: its own, or the mean of its corners. */
export function ofTet(field, t) {
  if (!field.at_points) return field.values[t];
  let sum = 0;
  for (let k = 0; k < 4; k++) sum += field.values[corner(t, k)];
  return sum / 4;
}

/** The mean value of the corners of the k-th triangle. */
export function ofTriangle(field, triangles, k) {
  return (field.values[triangles[3 * k]] + field.values[triangles[3 * k + 1]] + field.values[triangles[3 * k + 2]]) / 3;
}

const within = value => value >= threshold.least && value <= threshold.most;
const restricts = () => threshold.field && (threshold.least > -Infinity || threshold.most < Infinity);

/** All values of elements, for a histogram: of tetrahedra, else of the triangles of sheets. */
export function elementValues(field) {
  if (body) return Float32Array.from({ length: body.part.length }, (_, t) => ofTet(field, t));
  const sheets = data.parts.filter(part => part.group === "sheet");
  return Float32Array.from((sheets.length ? sheets : data.parts).flatMap(part =>
    Array.from({ length: part.triangles.length / 3 }, (_, k) => ofTriangle(field, part.triangles, k))));
}

/** A mask of the tetrahedra that are shown; null for all. `cut` tells which side a point is on. */
export function keptTets(cut) {
  if (!body || (!cut && !restricts())) return null;
  const kept = new Uint8Array(body.part.length);
  for (let t = 0; t < kept.length; t++) {
    if (restricts() && !within(ofTet(threshold.field, t))) continue;
    if (cut) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += cut(corner(t, k), body.part[t]);
      if (sum < 0) continue;
    }
    kept[t] = 1;
  }
  return kept;
}

/**
 * What is shown of the triangles of a surface, cut exactly where the field leaves the range: corners as
 * two nodes and the share between them.
 */
export function keptCorners(triangles) {
  const corners = Array.from(triangles, node => [node, node, 0]);
  if (!restricts() || !threshold.field.at_points) return corners;
  const result = [];
  for (let k = 0; k < triangles.length; k += 3) {
    const polygon = [0, 1, 2].flatMap(j => shownOfEdge(triangles[k + j], triangles[k + (j + 1) % 3]));
    for (let j = 1; j + 1 < polygon.length; j++) result.push(polygon[0], polygon[j], polygon[j + 1]);
  }
  return result;
}

/** The ends of what is shown of an edge, without its last node: the next edge has it. */
function shownOfEdge(a, b) {
  const { field, least, most } = threshold, from = field.values[a], rise = field.values[b] - from;
  if (rise === 0) return within(from) ? [[a, b, 0]] : [];
  const at = [(least - from) / rise, (most - from) / rise];
  const first = Math.max(0, Math.min(...at)), last = Math.min(1, Math.max(...at));
  if (first > last) return [];
  return last < 1 && last > first ? [[a, b, first], [a, b, last]] : [[a, b, first]];
}

// as decomp.meshes.incidence.FACES
const FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/** The corners of triangles between tetrahedra (`tets`) of a part that are kept and all else, and whose each is. */
export function hull(tets, number, kept) {
  const corners = [], owner = [];
  for (const t of tets) {
    if (kept && !kept[t]) continue;
    for (let f = 0; f < 4; f++) {
      const other = body.neighbours[4 * t + f];
      if (other >= 0 && body.part[other] === number && (!kept || kept[other])) continue;
      for (const k of FACES[f]) corners.push([corner(t, k), corner(t, k), 0]);
      owner.push(t);
    }
  }
  return { corners, owner };
}

/**
 * Where tetrahedra (`tets`) are cut, or touch the plane from the side that is kept: triangles as corners on edges
 * (two nodes and a share each), and the tetrahedron of each; `distance` (by node) is 0 on the plane. The outlines
 * are pairs of corners.
 */
export function cut(tets, kept, distance, offset) {
  const corners = [], owner = [], outlines = [];
  const from = node => { const d = distance[node] + offset; return Math.abs(d) < ON ? 0 : d; };
  const sides = [[], []];
  for (const t of tets) {
    if (kept && !kept[t]) continue;
    sides[0].length = sides[1].length = 0;
    for (let k = 0; k < 4; k++) sides[from(corner(t, k)) > 0 ? 0 : 1].push(corner(t, k));
    const [inside, outside] = sides;
    if (!inside.length || !outside.length) continue;
    const on = (a, b) => [a, b, from(a) / (from(a) - from(b))];
    const polygon = inside.length === 2
      ? [on(inside[0], outside[0]), on(inside[0], outside[1]), on(inside[1], outside[1]), on(inside[1], outside[0])]
      : inside.flatMap(a => outside.map(b => on(a, b)));
    for (let k = 1; k + 1 < polygon.length; k++) {
      corners.push(polygon[0], polygon[k], polygon[k + 1]);
      owner.push(t);
    }
    polygon.forEach((each, k) => outlines.push(each, polygon[(k + 1) % polygon.length]));
  }
  return { corners, owner, outlines };
}

/** The places (three numbers each) of corners: two nodes and the share between them. */
export function places(corners) {
  const at = new Float32Array(3 * corners.length);
  corners.forEach(([a, b, share], k) => {
    for (let axis = 0; axis < 3; axis++) {
      at[3 * k + axis] = points[3 * a + axis] + share * (points[3 * b + axis] - points[3 * a + axis]);
    }
  });
  return at;
}
