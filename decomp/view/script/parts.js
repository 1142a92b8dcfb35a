// Parts as surfaces with edges: what is drawn of each, apart from sections.

import * as THREE from "three";
import { body, data, points } from "decomp/data";
import { colourAt } from "decomp/colours";
import { hull, keptCorners, places } from "decomp/elements";

const CREASE = 25; // degrees: edges of skeletons are drawn where triangles meet at more
const GLASS = 0.15;

export const scene = new THREE.Scene();
export const plane = new THREE.Plane(new THREE.Vector3(0, -1, 0), 1e3);

/** How opaque each group is: the faces around a skeleton are glass. */
export const opacity = Object.fromEntries(["cell", "sheet", "interface", "face"].map(group => [group, 1]));
if (!body && data.parts.some(part => part.group === "sheet")) opacity.face = GLASS;

export function geometryOf(corners) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
  return geometry;
}

/** Surfaces are drawn a little behind lines, and those of cells and faces behind sheets and sections. */
export const BEHIND_LINES = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
const FARTHER = { polygonOffsetFactor: 2, polygonOffsetUnits: 4 };
export const lineMaterial = opacity =>
  new THREE.LineBasicMaterial({ color: 0x222222, transparent: opacity < 1, opacity });
const EDGE = 0.75;

class Piece {
  constructor(part, number) {
    Object.assign(this, part, { part, number, corners: [], owner: null, stale: true });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({
      vertexColors: true, side: THREE.DoubleSide, ...BEHIND_LINES, ...(part.group === "sheet" ? {} : FARTHER) }));
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial(EDGE));
    this.mesh.add(this.lines);
    this.mesh.userData.piece = this;
    this.mesh.material.clippingPlanes = this.lines.material.clippingPlanes = [plane];
    scene.add(this.mesh);
  }

  get visible() { return this.mesh.visible; }

  /** Build the surface of the elements that are shown. */
  build(kept) {
    const found = this.tets ? hull(this.tets, this.number, kept) : { corners: keptCorners(this.triangles), owner: null };
    Object.assign(this, found);
    const at = places(this.corners);
    this.mesh.geometry.dispose();
    this.lines.geometry.dispose();
    const geometry = this.mesh.geometry = geometryOf(at);
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(at.length), 3));
    geometry.computeVertexNormals();
    this.lines.geometry = body ? this.elementEdges() : new THREE.EdgesGeometry(geometry, CREASE);
    this.stale = false;
    this.paint();
  }

  /** Every edge of the triangles; a closed surface has each of them both ways. */
  elementEdges() {
    const ends = [];
    this.corners.forEach((from, k) => {
      const to = this.corners[k % 3 === 2 ? k - 2 : k + 1];
      if (!this.tets || from[0] < to[0]) ends.push(from, to);
    });
    return geometryOf(places(ends));
  }

  paint() {
    const colour = this.mesh.geometry.getAttribute("color");
    if (!colour) return;
    this.corners.forEach((corner, k) => {
      const { r, g, b } = colourAt(this.part, this.owner ? this.owner[Math.floor(k / 3)] : -1, ...corner);
      colour.setXYZ(k, r, g, b);
    });
    colour.needsUpdate = true;
  }

  /** As opaque as its group; what is glass hides nothing. */
  showOpacity() {
    const value = opacity[this.group], glass = value < 1;
    Object.assign(this.mesh.material, { transparent: glass, opacity: value, depthWrite: !glass, needsUpdate: true });
    Object.assign(this.lines.material, { opacity: EDGE * Math.min(1, 2.5 * value) });
  }
}

/** The middle of the box around some nodes. */
function centre(nodes) {
  const box = new THREE.Box3(), at = new THREE.Vector3();
  for (const node of nodes) box.expandByPoint(at.fromArray(points, 3 * node));
  return nodes.length ? box.getCenter(new THREE.Vector3()) : new THREE.Vector3();
}

export const pieces = data.parts.map((part, number) => new Piece(part, number));
if (body) {
  const lists = pieces.map(() => []);
  body.part.forEach((number, t) => lists[number].push(t));
  pieces.forEach((piece, k) => { if (!piece.triangles) piece.tets = Int32Array.from(lists[k]); });
}
for (const piece of pieces) {
  piece.centre = centre(piece.triangles ?? Array.from(piece.tets).flatMap(t => [...body.tets.subarray(4 * t, 4 * t + 4)]));
  piece.showOpacity();
}
