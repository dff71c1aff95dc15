/** Which display shows a topic: by type, with settings that suit its name. */

import type { Topic } from "../connection/connection";
import { CONTACTS, ODOMETRY } from "../robot/names";
import type { Display, DisplayTraits, Surroundings } from "./display";
import { GridMapDisplay } from "./displays/grid_map";
import { MarkersDisplay } from "./displays/markers";
import { ModelDisplay } from "./displays/models";
import { CloudDisplay, RangeDisplay, ScanDisplay } from "./displays/points";
import { PathDisplay, PointDisplay, PolygonDisplay, PosesDisplay } from "./displays/poses";
import { ContactsDisplay, OdometryDisplay } from "./displays/robot";

type Maker = new (around: Surroundings, topic: string, type: string, traits: DisplayTraits) => Display;

const POINT_SIZE = { value: 3, low: 1, high: 12, unit: "px" };
const LINE_SIZE = { value: 2.5, low: 1, high: 12, unit: "px" };
const ARROW_SIZE = { value: 16, low: 6, high: 60, unit: "px" };

/** Types in the order of drawing. Clouds are large: they are subscribed to on request. */
const KINDS: readonly [type: string, make: Maker, traits: Omit<DisplayTraits, "title">][] = [
  ["nav_msgs/msg/OccupancyGrid", GridMapDisplay, { order: 10, isShown: true, rateHz: 5, choices: { label: "Colours", values: ["map", "cost"] } }],
  ["sensor_msgs/msg/PointCloud2", CloudDisplay, { order: 30, isShown: false, colour: "laser", size: POINT_SIZE, hasDecay: true, rateHz: 20, choices: { label: "Colour by", values: ["height", "intensity", "flat"] } }],
  ["sensor_msgs/msg/LaserScan", ScanDisplay, { order: 31, isShown: true, colour: "laser", size: POINT_SIZE, hasDecay: true, rateHz: 20 }],
  ["sensor_msgs/msg/Range", RangeDisplay, { order: 32, isShown: true, colour: "laser", size: LINE_SIZE, hasDecay: true, rateHz: 10 }],
  ["visualization_msgs/msg/MarkerArray", MarkersDisplay, { order: 35, isShown: true, every: true }],
  ["visualization_msgs/msg/Marker", MarkersDisplay, { order: 35, isShown: true, every: true }],
  ["geometry_msgs/msg/PolygonStamped", PolygonDisplay, { order: 40, isShown: true, colour: "mark", size: LINE_SIZE, rateHz: 10 }],
  ["geometry_msgs/msg/PointStamped", PointDisplay, { order: 41, isShown: true, colour: "mark", size: ARROW_SIZE, rateHz: 10 }],
  ["geometry_msgs/msg/PoseArray", PosesDisplay, { order: 42, isShown: true, colour: "mark", size: ARROW_SIZE, rateHz: 10 }],
  ["nav2_msgs/msg/ParticleCloud", PosesDisplay, { order: 42, isShown: true, colour: "mark", size: ARROW_SIZE, rateHz: 10 }],
  ["geometry_msgs/msg/PoseWithCovarianceStamped", PosesDisplay, { order: 43, isShown: true, colour: "mark", size: ARROW_SIZE, rateHz: 10 }],
  ["geometry_msgs/msg/PoseStamped", PosesDisplay, { order: 43, isShown: true, colour: "mark", size: ARROW_SIZE, hasDecay: true, rateHz: 10 }],
  ["nav_msgs/msg/Odometry", OdometryDisplay, { order: 45, isShown: true, colour: "trail", size: { ...LINE_SIZE, value: 2 }, rateHz: 20 }],
  ["nav_msgs/msg/Path", PathDisplay, { order: 50, isShown: true, colour: "thread", size: LINE_SIZE, rateHz: 10 }],
];

/** What differs for some topics: hidden at first where another display shows the same. */
function traitsOf(topic: string, type: string, has: (topic: string) => boolean): Partial<DisplayTraits> {
  const isCost = /costmap/.test(topic);
  if (type.endsWith("/OccupancyGrid")) {
    const order = topic === "/map" ? 10 : 11;
    const values = isCost ? ["cost", "map"] : ["map", "cost"];
    return { order, isShown: topic === "/map" || !has("/map"), opacity: isCost ? 0.7 : 1, choices: { label: "Colours", values } };
  }
  if (topic === "/plan" || topic === "/plan_smoothed") return { isShown: !has("/path") };
  // Where the robot was, as SLAM corrects it: below the path, in the colour of the odometry's trail.
  if (topic.endsWith("/trajectory") && type.endsWith("/Path")) return { order: 44, colour: "trail", size: { ...LINE_SIZE, value: 1.5 }, opacity: 0.7 };
  if (/trajector|rollout|candidates/.test(topic)) return { order: 49 };
  if (topic === "/amcl_pose" || topic.startsWith("/planner/") || topic.endsWith("/published_footprint")) return { isShown: false };
  // The goal has a mark of its own, and what people publish here is no state.
  if (["/goal_point", "/goal_pose", "/initialpose", "/clicked_point"].includes(topic)) return { isShown: false };
  if (type.endsWith("/Odometry")) {
    const first = ODOMETRY.find(has);
    return { isShown: first === undefined || topic === first };
  }
  if (type.endsWith("/PoseStamped") || type.endsWith("/PoseWithCovarianceStamped")) return { isShown: true };
  return {};
}

/** Topics whose type does not say what they carry. */
function namedDisplay(around: Surroundings, { name, type }: Topic): Display | null {
  if (type === "std_msgs/msg/String" && name.endsWith("robot_description")) {
    return new ModelDisplay(around, name, type, { title: "Robot model", order: 60, isShown: true, colour: "quiet", opacity: 1, every: true });
  }
  if (type === "std_msgs/msg/String" && name.endsWith("world_description")) {
    return new ModelDisplay(around, name, type, { title: "World shapes", order: 12, isShown: "3d", colour: "quiet", opacity: 0.9, every: true });
  }
  if (name === CONTACTS && type === "diagnostic_msgs/msg/DiagnosticArray") {
    const size = { ...ARROW_SIZE, value: 14 };
    return new ContactsDisplay(around, name, type, { title: "Contacts", order: 70, isShown: true, colour: "bad", size });
  }
  return null;
}

/** A display for a topic; null for a type that the scene does not draw. */
export function displayOf(around: Surroundings, topic: Topic): Display | null {
  const named = namedDisplay(around, topic);
  if (named) return named;
  const kind = KINDS.find(([type]) => type === topic.type);
  if (!kind) return null;
  const [type, make, traits] = kind;
  const has = (name: string): boolean => around.connection.topics.get(name)?.isPublished ?? false;
  return new make(around, topic.name, type, { title: topic.name, ...traits, ...traitsOf(topic.name, type, has) });
}
