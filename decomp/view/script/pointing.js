// The name of what is under the pointer.

import * as THREE from "three";
import { get, said } from "decomp/data";
import { chosenField } from "decomp/colours";
import { opacity, pieces, plane } from "decomp/parts";
import { camera, isHeld, renderer } from "decomp/looking";

const SOLID = 0.5; // what is less opaque is pointed through
const WALL = 1e-5;
const ray = new THREE.Raycaster(), spot = new THREE.Vector2(), tip = get("tip"), canvas = renderer.domElement;

/** The part seen at a place of the window, with its tetrahedron and a node there where known; null for none. */
export function seenAt(x, y) {
  const box = canvas.getBoundingClientRect();
  spot.set((x - box.left) / box.width * 2 - 1, 1 - (y - box.top) / box.height * 2);
  ray.setFromCamera(spot, camera);
  const shown = pieces.filter(piece => piece.visible && opacity[piece.group] >= SOLID);
  const hits = ray.intersectObjects(shown.flatMap(piece => piece.cap?.visible ? [piece.mesh, piece.cap] : [piece.mesh]), false);
  const left = hits.filter(hit => !hit.object.material.clippingPlanes?.length || plane.distanceToPoint(hit.point) >= 0);
  if (!left.length) return null;
  // a cell that is filled where it is cut is left through a wall that is the next one's too
  const hit = left.find(each => each.distance < left[0].distance + WALL && each.face.normal.dot(ray.ray.direction) > 0) ?? left[0];
  const { piece } = hit.object.userData, capped = hit.object === piece.cap;
  const { owner, corners } = capped ? piece.cut : piece;
  return { piece, tet: owner?.[hit.faceIndex] ?? -1, node: corners[3 * hit.faceIndex][0] };
}

function value({ piece, tet, node }) {
  const field = chosenField();
  if (!field || (!field.at_points && tet < 0)) return "";
  return `, ${field.name} ${said(field.values[field.at_points ? node : tet])}`;
}

function hover(event) {
  const seen = isHeld() && event.type === "pointermove" ? null : seenAt(event.clientX, event.clientY);
  tip.style.display = seen ? "block" : "none";
  if (!seen) return;
  const { name, kind, group } = seen.piece;
  tip.textContent = name + (group === "sheet" && kind !== group ? `, ${kind}` : "") + value(seen);
  const box = canvas.getBoundingClientRect();
  tip.style.left = `${Math.min(event.clientX - box.left + 14, Math.max(4, box.width - tip.offsetWidth - 4))}px`;
  tip.style.top = `${Math.min(event.clientY - box.top + 14, box.height - tip.offsetHeight - 4)}px`;
}
for (const kind of ["pointermove", "pointerdown"]) canvas.addEventListener(kind, hover);
canvas.addEventListener("pointerleave", () => { tip.style.display = "none"; });
