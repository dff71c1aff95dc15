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

/** Between a (0) and b (1): the translation on a straight line, the rotation at a constant rate the shorter way round. */
export function interpolate(a: Transform, b: Transform, share: number): Transform {
  const mix = (from: number, to: number): number => from + (to - from) * share;
  const [ax, ay, az] = a.translation;
  const [bx, by, bz] = b.translation;
  return { translation: [mix(ax, bx), mix(ay, by), mix(az, bz)], rotation: slerp(a.rotation, b.rotation, share) };
}

/** Spherical interpolation (K. Shoemake, "Animating rotation with quaternion curves", 1985). */
function slerp(a: Quaternion, b: Quaternion, share: number): Quaternion {
  const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const angle = Math.acos(Math.min(1, Math.abs(dot)));
  const sine = Math.sin(angle);
  // Below 1e-6 rad the sines divide by almost nothing, and a straight line is as good.
  const [u, v] = sine < 1e-6 ? [1 - share, share] : [Math.sin((1 - share) * angle) / sine, Math.sin(share * angle) / sine];
  const w = dot < 0 ? -v : v; // q and -q are the same rotation
  return [u * a[0] + w * b[0], u * a[1] + w * b[1], u * a[2] + w * b[2], u * a[3] + w * b[3]];
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
