// What the page holds, decoded: points scaled to a box around the origin whose diagonal is 2.

const text = document.getElementById("data").textContent;
export const data = JSON.parse(text);

function bytes(base64) {
  const raw = atob(base64), result = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) result[k] = raw.charCodeAt(k);
  return result.buffer;
}
const floats = base64 => new Float32Array(bytes(base64));
const whole = base64 => new Int32Array(bytes(base64));

export const points = floats(data.points);
export const low = [0, 0, 0], high = [0, 0, 0];
for (let axis = 0; axis < 3; axis++) {
  low[axis] = Infinity; high[axis] = -Infinity;
  for (let k = axis; k < points.length; k += 3) {
    low[axis] = Math.min(low[axis], points[k]);
    high[axis] = Math.max(high[axis], points[k]);
  }
}
export const middle = low.map((value, axis) => (value + high[axis]) / 2);
export const scale = 2 / (Math.hypot(...low.map((value, axis) => high[axis] - value)) || 1);
for (let k = 0; k < points.length; k++) points[k] = (points[k] - middle[k % 3]) * scale;

/** A coordinate of the model from one of the page. */
export const inModel = (value, axis) => value / scale + middle[axis] + data.origin[axis];

export const body = data.body && {
  tets: whole(data.body.tets), part: whole(data.body.part), neighbours: whole(data.body.neighbours),
};
export const fields = data.fields.map(field => ({ ...field, values: floats(field.values) }));
for (const part of data.parts) part.triangles = part.triangles && whole(part.triangles);

/** A number as people read it. */
export const said = value => String(Number(value.toPrecision(4)));
export const get = id => document.getElementById(id);

/** A new element with properties and children. */
export function made(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
