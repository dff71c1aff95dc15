/** Rigid transforms: `map_T_base` maps points of base to map. */

export type Vector = readonly [number, number, number];
/** x, y, z, w. */
export type Quaternion = readonly [number, number, number, number];

export interface Transform {
  readonly translation: Vector;
  readonly rotation: Quaternion;
}

export const IDENTITY: Transform = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };

/** R(q) v, for a quaternion of length one. */
export function rotate([qx, qy, qz, qw]: Quaternion, [x, y, z]: Vector): Vector {
  const tx = 2 * (qy * z - qz * y);
  const ty = 2 * (qz * x - qx * z);
  const tz = 2 * (qx * y - qy * x);
  return [
    x + qw * tx + qy * tz - qz * ty,
    y + qw * ty + qz * tx - qx * tz,
    z + qw * tz + qx * ty - qy * tx,
  ];
}

export function apply({ translation: [x, y, z], rotation }: Transform, point: Vector): Vector {
  const [px, py, pz] = rotate(rotation, point);
  return [x + px, y + py, z + pz];
}

/** a_T_c = a_T_b b_T_c. */
export function compose(a: Transform, b: Transform): Transform {
  const [ax, ay, az, aw] = a.rotation;
  const [bx, by, bz, bw] = b.rotation;
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

export function inverse({ translation, rotation: [x, y, z, w] }: Transform): Transform {
  const back: Quaternion = [-x, -y, -z, w];
  const [tx, ty, tz] = rotate(back, translation);
  return { translation: [-tx, -ty, -tz], rotation: back };
}

export function yawOf([x, y, z, w]: Quaternion): number {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

export function fromYaw(yaw: number): Quaternion {
  return [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
}

/** x, y, z roll, pitch and yaw of URDF, in this order about fixed axes. */
export function fromRollPitchYaw(roll: number, pitch: number, yaw: number): Quaternion {
  const [cr, sr] = [Math.cos(roll / 2), Math.sin(roll / 2)];
  const [cp, sp] = [Math.cos(pitch / 2), Math.sin(pitch / 2)];
  const [cy, sy] = [Math.cos(yaw / 2), Math.sin(yaw / 2)];
  return [
    sr * cp * cy - cr * sp * sy,
    cr * sp * cy + sr * cp * sy,
    cr * cp * sy - sr * sp * cy,
    cr * cp * cy + sr * sp * sy,
  ];
}
