// Transforms from /tf and /tf_static: the newest of each frame, chained to a fixed one.
"use strict";

const frames = {
  parents: new Map(), // child → { parent, translation, rotation }

  clear() { this.parents.clear(); },

  take(reader) {
    for (let left = reader.u32(); left > 0; left--) {
      const parent = reader.header(), child = reader.text();
      this.parents.set(child, { parent, ...readTransform(reader) });
    }
  },

  /** fixed_T_frame as { translation, rotation }, or null while they do not connect. */
  lookUp(fixed, frame) {
    const up = this.chain(frame), down = this.chain(fixed);
    const common = [...up.keys()].find((name) => down.has(name));
    return common === undefined ? null : compose(inverse(down.get(common)), up.get(common));
  },

  /** ancestor → ancestor_T_frame, the frame itself first. */
  chain(frame) {
    const found = new Map([[frame, IDENTITY]]);
    let link;
    while ((link = this.parents.get(frame)) && !found.has(link.parent)) {
      found.set(link.parent, compose(link, found.get(frame)));
      frame = link.parent;
    }
    return found;
  },
};

const IDENTITY = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };

function readTransform(reader) {
  const [x, y, z, qx, qy, qz, qw] = Array.from({ length: 7 }, () => reader.f64());
  return { translation: [x, y, z], rotation: [qx, qy, qz, qw] };
}

/** R(q) v, for q = [x, y, z, w] of length one. */
function rotate([qx, qy, qz, qw], [x, y, z]) {
  const tx = 2 * (qy * z - qz * y), ty = 2 * (qz * x - qx * z), tz = 2 * (qx * y - qy * x);
  return [
    x + qw * tx + qy * tz - qz * ty,
    y + qw * ty + qz * tx - qx * tz,
    z + qw * tz + qx * ty - qy * tx,
  ];
}
function apply({ translation: [x, y, z], rotation }, point) {
  const [px, py, pz] = rotate(rotation, point);
  return [x + px, y + py, z + pz];
}
function compose(a, b) {
  const [ax, ay, az, aw] = a.rotation, [bx, by, bz, bw] = b.rotation;
  return {
    translation: apply(a, b.translation),
    rotation: [
      aw * bx + ax * bw + ay * bz - az * by,
      aw * by - ax * bz + ay * bw + az * bx,
      aw * bz + ax * by - ay * bx + az * bw,
      aw * bw - ax * bx - ay * by - az * bz,
    ],
  };
}
function inverse({ translation, rotation: [x, y, z, w] }) {
  const back = [-x, -y, -z, w];
  return { translation: rotate(back, translation).map((value) => -value), rotation: back };
}
const yawOf = ([x, y, z, w]) => Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
