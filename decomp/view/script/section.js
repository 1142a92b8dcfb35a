// Sections: a plane that cuts away what is before it, and the cut surface, filled.
//
// Tetrahedra are cut exactly. The closed surfaces of a skeleton's cells are filled where a line of sight
// through the plane has entered them more often than left them, counted in the stencil.

import * as THREE from "three";
import { body, get, high, inModel, low, points, said, scale } from "decomp/data";
import { colourAt } from "decomp/colours";
import { cut, keptTets, places } from "decomp/elements";
import { geometryOf, lineMaterial, pieces, plane, scene, BEHIND_LINES } from "decomp/parts";

const REACH = 1.5; // the farthest that parts are moved out, in parts of their distance from the middle
const NOWHERE = 1e3;

export const section = { axis: 1, side: 1, share: 0, whole: false, exploded: 0 };
let distance = new Float32Array(0);

export const isCut = () => section.share > 0;
const byWhole = () => isCut() && section.whole;

// a place to a hundred-thousandth of the model, without the digits that single precision leaves behind
const STEP = 10 ** Math.floor(Math.log10(2e-5 / scale));
const rounded = value => Math.round(value / STEP) * STEP;

/** Put the plane where the controls say, and the parts where they are exploded to. */
export function placeAll() {
  const { axis, side, share, exploded } = section;
  for (const piece of pieces) piece.mesh.position.copy(piece.centre).multiplyScalar(REACH * exploded);
  const half = (high[axis] - low[axis]) / 2 * scale * (1 + REACH * exploded);
  // at the end nothing is left, not even what lies in the plane
  const at = side * (1 - 2 * share) * half - (share < 1 ? 0 : side * 1e-3);
  plane.normal.set(0, 0, 0).setComponent(axis, -side);
  plane.constant = isCut() ? side * at : NOWHERE;
  get("slice-said").textContent = isCut() ? `${"xyz"[axis]} = ${said(rounded(inModel(at, axis)))}` : "";
  for (const piece of pieces) {
    const clipping = byWhole() && piece.tets ? [] : [plane];
    piece.mesh.material.clippingPlanes = piece.lines.material.clippingPlanes = clipping;
  }
}

function shift(piece) { return plane.normal.dot(piece.mesh.position) + plane.constant; }

/** The tetrahedra that are shown: by value, and by the section if it follows whole ones. */
export function kept() {
  if (!byWhole()) return keptTets(null);
  measure();
  const shifts = pieces.map(shift);
  return keptTets((node, part) => distance[node] + shifts[part]);
}

function measure() {
  if (!distance.length) distance = new Float32Array(points.length / 3);
  const { x, y, z } = plane.normal;
  for (let k = 0; k < distance.length; k++) distance[k] = x * points[3 * k] + y * points[3 * k + 1] + z * points[3 * k + 2];
}

/** Fill the cut surfaces anew. */
export function cap(mask, edges) {
  const cutting = isCut() && !byWhole();
  if (cutting && body) measure();
  for (const piece of pieces) {
    const wanted = cutting && piece.visible && (piece.tets || piece.group === "cell");
    if (piece.tets) fill(piece, wanted, mask, edges);
    else if (piece.group === "cell") stencil(piece, wanted);
  }
}

function fill(piece, wanted, mask, edges) {
  if (!piece.cap) {
    if (!wanted) return;
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, ...BEHIND_LINES });
    piece.cap = new THREE.Mesh(new THREE.BufferGeometry(), material);
    piece.cap.userData.piece = piece;
    piece.capLines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial(0.4));
    piece.cap.add(piece.capLines);
    piece.mesh.add(piece.cap);
  }
  piece.cap.visible = Boolean(wanted);
  piece.capLines.visible = edges;
  if (!wanted) return;
  const found = cut(piece.tets, mask, distance, shift(piece));
  const at = places(found.corners);
  piece.cut = found;
  piece.cap.geometry.dispose();
  piece.capLines.geometry.dispose();
  piece.cap.geometry = geometryOf(at);
  piece.cap.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(at.length), 3));
  piece.capLines.geometry = geometryOf(places(found.outlines));
  paintCap(piece);
}

/** Colour the filled surfaces anew. */
export function paintCaps() {
  for (const piece of pieces) {
    if (piece.cap?.visible) paintCap(piece);
    piece.lid?.material.color.copy(colourAt(piece.part, -1, 0, 0, 0));
  }
}

function paintCap(piece) {
  const colour = piece.cap.geometry.getAttribute("color");
  piece.cut.corners.forEach((each, k) => {
    const { r, g, b } = colourAt(piece.part, piece.cut.owner[Math.floor(k / 3)], ...each);
    colour.setXYZ(k, r, g, b);
  });
  colour.needsUpdate = true;
}

function counting(piece, side, operation) {
  const material = new THREE.MeshBasicMaterial({ side, clippingPlanes: [plane], colorWrite: false, depthWrite: false,
    depthTest: false, stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, stencilZPass: operation });
  return new THREE.Mesh(piece.mesh.geometry, material);
}

/** Fill a closed surface: count in the stencil, then draw a lid where the count is not 0, which clears it. */
function stencil(piece, wanted) {
  if (!piece.lid) {
    if (!wanted) return;
    piece.counts = [counting(piece, THREE.BackSide, THREE.IncrementWrapStencilOp),
      counting(piece, THREE.FrontSide, THREE.DecrementWrapStencilOp)];
    piece.lid = new THREE.Mesh(new THREE.PlaneGeometry(20, 20), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide,
      stencilWrite: true, stencilRef: 0, stencilFunc: THREE.NotEqualStencilFunc, stencilFail: THREE.ZeroStencilOp,
      stencilZFail: THREE.ZeroStencilOp, stencilZPass: THREE.ZeroStencilOp }));
    piece.lid.material.color.copy(colourAt(piece.part, -1, 0, 0, 0));
    piece.counts.forEach((mesh, k) => { mesh.renderOrder = 10 * piece.number + k + 1; piece.mesh.add(mesh); });
    piece.lid.renderOrder = 10 * piece.number + 3;
    scene.add(piece.lid);
  }
  for (const mesh of piece.counts) {
    mesh.visible = Boolean(wanted);
    mesh.geometry = piece.mesh.geometry;
  }
  piece.lid.visible = Boolean(wanted);
  plane.coplanarPoint(piece.lid.position);
  piece.lid.lookAt(piece.lid.position.clone().add(plane.normal));
}
