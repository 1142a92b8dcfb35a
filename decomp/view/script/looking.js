// The camera: turning, moving, coming nearer, standard views, and the triad that tells directions.

import * as THREE from "three";
import { get, high, low, made, scale } from "decomp/data";
import { scene } from "decomp/parts";
import { section } from "decomp/section";

const START = { around: -0.9, up: 0.45 };
const VIEWS = { iso: START, "+x": { around: 0, up: 0 }, "-x": { around: Math.PI, up: 0 },
  "+y": { around: Math.PI / 2, up: 0 }, "-y": { around: -Math.PI / 2, up: 0 },
  "+z": { around: -Math.PI / 2, up: 1.57 }, "-z": { around: -Math.PI / 2, up: -1.57 } };
const FIELD = 35, FREE = 1.1, NEAREST = 0.1, FARTHEST = 30, TRIAD = 84;

function started() {
  try {
    return new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true, stencil: true });
  } catch (error) {
    get("stage").append(made("p", { id: "without", textContent: "This browser does not draw in three dimensions (WebGL): " +
      "allow it to use the graphics card, or take a picture with decomp view -o picture.png." }));
    throw error;
  }
}

export const renderer = started();
renderer.localClippingEnabled = true;
renderer.autoClear = false;
renderer.setPixelRatio(window.devicePixelRatio);
renderer.setClearColor(0xffffff);
const stage = get("stage"), canvas = renderer.domElement;
stage.prepend(canvas);

export const camera = new THREE.PerspectiveCamera(FIELD, 1, 0.01, 100);
camera.up.set(0, 0, 1);
function light(where, eye) {
  where.add(new THREE.HemisphereLight(0xffffff, 0xb0b0b0, 2.2), eye);
  const lamp = new THREE.DirectionalLight(0xffffff, 1.4);
  lamp.position.set(0.4, 0.6, 1);
  eye.add(lamp);
}
light(scene, camera);

const compass = new THREE.Scene(), compassEye = new THREE.OrthographicCamera(-1.5, 1.5, 1.5, -1.5, 0.1, 10);
compassEye.up.set(0, 0, 1);
function letter(text) {
  const drawn = made("canvas", { width: 64, height: 64 }), pen = drawn.getContext("2d");
  pen.font = "bold 52px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, 32, 32);
  return new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(drawn) }));
}
["#D55E00", "#009E73", "#0072B2"].forEach((colour, axis) => {
  const way = new THREE.Vector3().setComponent(axis, 1), sign = letter("xyz"[axis]);
  sign.position.copy(way).multiplyScalar(1.25);
  sign.scale.setScalar(0.5);
  compass.add(new THREE.ArrowHelper(way, new THREE.Vector3(), 1, colour, 0.3, 0.18), sign);
});

const half = new THREE.Vector3(...high.map((value, axis) => (value - low[axis]) / 2 * scale));
const whole = new THREE.Box3(half.clone().negate(), half);
let { around, up } = START, away = 1, home = 0;
const target = new THREE.Vector3();

/** How far the eye must be from a box's middle, to have all of it in the picture from where it looks. */
function distance(box) {
  const right = new THREE.Vector3(-Math.sin(around), Math.cos(around), 0);
  const above = new THREE.Vector3(-Math.sin(up) * Math.cos(around), -Math.sin(up) * Math.sin(around), Math.cos(up));
  const towards = right.clone().cross(above), middle = box.getCenter(new THREE.Vector3());
  const slope = Math.tan(FIELD / 2 * Math.PI / 180);
  let result = 0;
  for (let k = 0; k < 8; k++) {
    const corner = new THREE.Vector3(...["x", "y", "z"].map((axis, j) => box[k >> j & 1 ? "max" : "min"][axis])).sub(middle);
    const across = Math.max(Math.abs(corner.dot(right)) / camera.aspect, Math.abs(corner.dot(above)));
    result = Math.max(result, FREE * across / slope + corner.dot(towards));
  }
  return Math.max(result, NEAREST);
}

export function look() {
  camera.position.set(Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up));
  compassEye.position.copy(camera.position).multiplyScalar(5);
  camera.position.multiplyScalar(away * (1 + 0.8 * section.exploded)).add(target);
  camera.lookAt(target);
  compassEye.lookAt(0, 0, 0);
  draw();
}

/** Which side of the middle the eye is on, along an axis. */
export const nearSide = axis => camera.position.getComponent(axis) - target.getComponent(axis) < 0 ? -1 : 1;

export function draw() {
  const { clientWidth: width, clientHeight: height } = stage;
  renderer.setViewport(0, 0, width, height);
  renderer.setScissorTest(false);
  renderer.clear();
  renderer.render(scene, camera);
  renderer.setViewport(width - TRIAD, 0, TRIAD, TRIAD);
  renderer.clearDepth();
  renderer.render(compass, compassEye);
}

export function fit() {
  renderer.setSize(stage.clientWidth, stage.clientHeight);
  camera.aspect = stage.clientWidth / Math.max(stage.clientHeight, 1);
  camera.updateProjectionMatrix();
  // what filled the stage before fills it now
  const before = home;
  home = distance(whole);
  away = before ? away * home / before : home;
  look();
}

/** Look at a box as a whole, from where the eye is or from one of the views. */
export function aim(box, view = { around, up }) {
  ({ around, up } = view);
  box.getCenter(target);
  away = distance(box);
  look();
}

for (const [name, view] of Object.entries(VIEWS)) {
  const said = name === "iso" ? "from above, aslant" : `seen from ${name}`;
  get("views").append(made("button", { type: "button", textContent: name, title: said, id: `view-${name}`,
    onclick: () => aim(whole, view) }));
}
get("views").append(made("button", { type: "button", textContent: "reset", title: "as it was at first", id: "reset",
  onclick: () => aim(whole, START) }));

function move(dx, dy) {
  const step = away / canvas.clientHeight * 0.63;
  target.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0), -dx * step)
    .addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1), dy * step);
}
function zoom(factor) { away = Math.min(FARTHEST, Math.max(NEAREST, away * factor)); }

const held = new Map(); // pointers that are down, by their numbers
let turns = true;
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("pointerdown", event => {
  held.set(event.pointerId, [event.clientX, event.clientY]);
  turns = event.button === 0 && !event.shiftKey;
  canvas.setPointerCapture(event.pointerId);
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => held.delete(event.pointerId));
canvas.addEventListener("pointermove", event => {
  const before = held.get(event.pointerId);
  if (!before) return;
  const dx = event.clientX - before[0], dy = event.clientY - before[1];
  const [other] = [...held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
  held.set(event.pointerId, [event.clientX, event.clientY]);
  if (other) {
    const gap = at => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1;
    zoom(gap(before) / gap([event.clientX, event.clientY]));
    move(dx / 2, dy / 2);
  } else if (turns) {
    around -= dx * 0.008;
    up = Math.min(1.57, Math.max(-1.57, up + dy * 0.008));
  } else move(dx, dy);
  look();
});
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  zoom(Math.exp(event.deltaY * 0.001));
  look();
}, { passive: false });
export const isHeld = () => held.size > 0;
