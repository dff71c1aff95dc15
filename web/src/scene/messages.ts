/** The fields of ROS messages that the scene reads. */

import type { Stamp } from "../transforms/stamp";
import type { Transform } from "../transforms/transform";

export interface Xyz { x: number; y: number; z: number }
export interface Rotation extends Xyz { w: number }
export interface Header { frame_id: string; stamp: Stamp }
export interface Pose { position: Xyz; orientation: Rotation }
export interface PoseStamped { header: Header; pose: Pose }
export interface PointStamped { header: Header; point: Xyz }
export interface PoseWithCovarianceStamped {
  header: Header;
  pose: { pose: Pose; covariance: ArrayLike<number> };
}
export interface PoseArray { header: Header; poses: Pose[] }
export interface ParticleCloud { header: Header; particles: { pose: Pose; weight: number }[] }
export interface Path { header: Header; poses: PoseStamped[] }
export interface Odometry {
  header: Header;
  child_frame_id: string;
  pose: { pose: Pose; covariance: ArrayLike<number> };
  twist: { twist: { linear: Xyz; angular: Xyz } };
}
export interface OccupancyGrid {
  header: Header;
  info: { resolution: number; width: number; height: number; origin: Pose };
  data: Int8Array | number[];
}
/** map_msgs/OccupancyGridUpdate: new values of some cells. */
export interface GridUpdate {
  header: Header;
  x: number;
  y: number;
  width: number;
  height: number;
  data: Int8Array | number[];
}
export interface LaserScan {
  header: Header;
  angle_min: number;
  angle_increment: number;
  range_min: number;
  range_max: number;
  ranges: ArrayLike<number>;
}
export interface PointCloud2 {
  header: Header;
  height: number;
  width: number;
  fields: { name: string; offset: number; datatype: number; count: number }[];
  is_bigendian: boolean;
  point_step: number;
  row_step: number;
  data: Uint8Array;
}
export interface Range { header: Header; field_of_view: number; min_range: number; max_range: number; range: number }
export interface PolygonStamped { header: Header; polygon: { points: Xyz[] } }
export interface Rgba { r: number; g: number; b: number; a: number }
export interface Marker {
  header: Header;
  ns: string;
  id: number;
  type: number;
  action: number;
  pose: Pose;
  scale: Xyz;
  color: Rgba;
  lifetime: Stamp;
  frame_locked: boolean;
  points: Xyz[];
  colors: Rgba[];
  text: string;
  mesh_resource: string;
}
export interface DiagnosticStatus {
  level: number;
  name: string;
  message: string;
  values: { key: string; value: string }[];
}

export interface DiagnosticArray { header: Header; status: DiagnosticStatus[] }

/** A pose as a transform; an all-zero rotation, as unset messages have, is none. */
export function transformOf({ position: p, orientation: q }: Pose): Transform {
  const length = Math.hypot(q.x, q.y, q.z, q.w);
  const rotation: Transform["rotation"] =
    length < 1e-6 ? [0, 0, 0, 1] : [q.x / length, q.y / length, q.z / length, q.w / length];
  return { translation: [p.x, p.y, p.z], rotation };
}

export function poseOf({ translation: [x, y, z], rotation: [qx, qy, qz, qw] }: Transform): Pose {
  return { position: { x, y, z }, orientation: { x: qx, y: qy, z: qz, w: qw } };
}

export function valuesOf(status: DiagnosticStatus): Record<string, string> {
  return Object.fromEntries(status.values.map(({ key, value }) => [key, value]));
}
