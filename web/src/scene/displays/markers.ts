/** visualization_msgs Marker and MarkerArray. */

import { Display, withProblem, type DisplayStatus } from "../display";
import { transformOf, type Marker } from "../messages";
import { colourOf, type Colour, type Mesh, type Part, type Primitive } from "../primitives";
import { nanosecondsOf } from "../../transforms/stamp";
import { apply, fromRollPitchYaw, type Transform, type Vector } from "../../transforms/transform";
import { Placement } from "../placement";
import { MeshStore } from "./meshes";

const ARROW = 0, CUBE = 1, SPHERE = 2, CYLINDER = 3, LINE_STRIP = 4, LINE_LIST = 5, CUBE_LIST = 6, SPHERE_LIST = 7;
const POINTS = 8, TEXT = 9, MESH = 10, TRIANGLES = 11;
const DELETE = 2, DELETE_ALL = 3;
const MOST_MARKERS = 5000;
/** Of a list that are drawn as bodies rather than points. */
const MOST_BODIES = 300;
/** Length of an arrow's head, of the arrow that a pose and a scale give. */
const HEAD_SHARE = 0.25;
const HEAD_SIDES = 12;

interface Kept {
  readonly marker: Marker;
  readonly placement: Placement;
  /** Time of the page at which its lifetime ends. */
  readonly untilMs: number;
}

export class MarkersDisplay extends Display<Marker | { markers: Marker[] }> {
  readonly #markers = new Map<string, Kept>();
  readonly #meshes = new MeshStore(this.around.connection, () => this.restyle());

  protected override take(value: Marker | { markers: Marker[] }): void {
    const placements = new Map<string, Placement>(); // markers of one frame and stamp are one part
    for (const marker of "markers" in value ? value.markers : [value]) this.#apply(marker, placements);
  }

  override clear(): void {
    this.#markers.clear();
    super.clear();
  }

  #apply(marker: Marker, placements: Map<string, Placement>): void {
    const key = `${marker.ns}/${marker.id}`;
    if (marker.action === DELETE_ALL) this.#markers.clear();
    else if (marker.action === DELETE) this.#markers.delete(key);
    else {
      const lifetimeMs = Number(nanosecondsOf(marker.lifetime)) / 1e6;
      const { frame_id: frame, stamp } = marker.header;
      const stampNs = marker.frame_locked ? 0n : nanosecondsOf(stamp);
      const placement = placements.get(`${stampNs} ${frame}`) ?? new Placement(this.around.transforms, frame, stampNs);
      placements.set(`${stampNs} ${frame}`, placement);
      this.#markers.set(key, { marker, placement, untilMs: lifetimeMs > 0 ? performance.now() + lifetimeMs : Infinity });
      if (this.#markers.size > MOST_MARKERS) this.#markers.delete(this.#markers.keys().next().value ?? "");
    }
  }

  protected override build(): Part[] {
    const now = performance.now();
    const groups = new Map<Placement, { primitives: Primitive[]; names: Map<Primitive, string> }>();
    for (const [key, { marker, placement, untilMs }] of this.#markers) {
      if (untilMs < now) {
        this.#markers.delete(key);
        continue;
      }
      const group = groups.get(placement) ?? { primitives: [], names: new Map<Primitive, string>() };
      groups.set(placement, group);
      for (const primitive of this.#primitives(marker)) {
        group.primitives.push(primitive);
        group.names.set(primitive, key);
      }
    }
    if ([...this.#markers.values()].some(({ untilMs }) => untilMs < Infinity)) {
      this.later(250, () => this.restyle()); // their lifetime ends without a message
    }
    return [...groups].map(([placement, { primitives, names }]) => ({
      frame: placement.frame,
      placement,
      primitives,
      about: (primitive) => [["marker", names.get(primitive) ?? ""]],
    }));
  }

  #primitives(marker: Marker): Primitive[] {
    const { scale, color, points } = marker;
    const pose = transformOf(marker.pose);
    const colour = colourOf(color.r, color.g, color.b, color.a);
    const size = [scale.x, scale.y, scale.z] as const;
    switch (marker.type) {
      case ARROW:
        return arrow(marker, colour);
      case CUBE:
        return [{ kind: "solid", shape: "box", pose, size, colour }];
      case SPHERE:
        return [{ kind: "solid", shape: "sphere", pose, size, colour }];
      case CYLINDER:
        return [{ kind: "solid", shape: "cylinder", pose, size, colour }];
      case LINE_STRIP:
      case LINE_LIST: {
        const positions = placed(marker);
        const mode = marker.type === LINE_STRIP ? "strip" : "segments";
        return points.length > 1 ? [{ kind: "lines", positions, mode, colour, widthPx: 2 }] : [];
      }
      case CUBE_LIST:
      case SPHERE_LIST:
        return points.length <= MOST_BODIES ? bodies(marker, marker.type === CUBE_LIST ? "box" : "sphere", colour) : dots(marker, colour);
      case POINTS:
        return dots(marker, colour);
      case TEXT:
        return [{ kind: "label", position: pose.translation, text: marker.text.slice(0, 200), colour, sizePx: 12 }];
      case MESH: {
        const mesh = this.#meshes.get(marker.mesh_resource);
        return mesh ? [{ kind: "solid", shape: "mesh", pose, size, colour, mesh }] : [];
      }
      case TRIANGLES: {
        const positions = Float32Array.from(points.flatMap(({ x, y, z }) => [x, y, z]));
        return [{ kind: "solid", shape: "mesh", pose, size, colour, mesh: { positions } }];
      }
      default:
        return [];
    }
  }

  override status(): DisplayStatus {
    return withProblem(super.status(), this.#meshes.problem);
  }

  protected override detail(): string {
    return this.#markers.size === 1 ? "1 marker" : `${this.#markers.size} markers`;
  }
}

/** From its pose along x, or from its first point to its second: a shaft and a head. */
function arrow(marker: Marker, colour: Colour): Primitive[] {
  const { scale } = marker;
  if (marker.points.length < 2) {
    return arrowAt(transformOf(marker.pose), [scale.x, scale.y, scale.z], HEAD_SHARE * scale.x, 0.6, colour);
  }
  const [x, y, z, toX, toY, toZ] = placed(marker) as unknown as [number, number, number, number, number, number];
  const [dx, dy, dz] = [toX - x, toY - y, toZ - z];
  const lengthM = Math.hypot(dx, dy, dz);
  const rotation = fromRollPitchYaw(0, -Math.atan2(dz, Math.hypot(dx, dy)), Math.atan2(dy, dx));
  // The scale is the diameters of shaft and head, and the length of the head.
  const shaft = scale.y > 0 ? scale.x / scale.y : 0.5;
  return arrowAt({ translation: [x, y, z], rotation }, [lengthM, scale.y, scale.y], scale.z > 0 ? Math.min(lengthM, scale.z) : HEAD_SHARE * lengthM, shaft, colour);
}

/** An arrow along x of a pose, from its tail; `shaft`: its share of the head's diameter. */
function arrowAt(pose: Transform, [x, y, z]: Vector, headM: number, shaft: number, colour: Colour): Primitive[] {
  const shaftM = x - headM;
  const middle = { ...pose, translation: apply(pose, [shaftM / 2, 0, 0]) };
  const neck = { ...pose, translation: apply(pose, [shaftM, 0, 0]) };
  return [
    { kind: "solid", shape: "box", pose: middle, size: [shaftM, shaft * y, shaft * z], colour },
    { kind: "solid", shape: "mesh", pose: neck, size: [headM, y, z], colour, mesh: HEAD },
  ];
}

/** A cone along x, of length and diameter one. */
const HEAD: Mesh = {
  positions: Float32Array.from(
    Array.from({ length: HEAD_SIDES }, (_, side) => {
      const rim = (index: number): Vector => {
        const angle = (2 * Math.PI * index) / HEAD_SIDES;
        return [0, Math.cos(angle) / 2, Math.sin(angle) / 2];
      };
      return [...rim(side), ...rim(side + 1), 1, 0, 0, ...rim(side + 1), ...rim(side), 0, 0, 0];
    }).flat(),
  ),
};

function dots(marker: Marker, colour: Colour): Primitive[] {
  const { colors, points } = marker;
  const each = colors.length === points.length ? { colours: coloursOf(marker) } : {};
  return points.length > 0 ? [{ kind: "points", positions: placed(marker), ...each, colour, sizePx: 4 }] : [];
}

function bodies(marker: Marker, shape: "box" | "sphere", colour: Colour): Primitive[] {
  const { scale, colors, points } = marker;
  const positions = placed(marker);
  const { rotation } = transformOf(marker.pose);
  return points.map((_, index) => {
    const own = colors.length === points.length ? colors[index] : undefined;
    const translation: Vector = [positions[3 * index]!, positions[3 * index + 1]!, positions[3 * index + 2]!];
    return {
      kind: "solid", shape, pose: { translation, rotation }, size: [scale.x, scale.y, scale.z],
      colour: own ? colourOf(own.r, own.g, own.b, own.a) : colour,
    };
  });
}

/** The marker's points in the frame of its header. */
function placed(marker: Marker): Float32Array {
  const { translation: [tx, ty, tz], rotation: [qx, qy, qz, qw] } = transformOf(marker.pose);
  const positions = new Float32Array(3 * marker.points.length);
  marker.points.forEach(({ x, y, z }, index) => {
    const [ax, ay, az] = [2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)];
    positions[3 * index] = tx + x + qw * ax + qy * az - qz * ay;
    positions[3 * index + 1] = ty + y + qw * ay + qz * ax - qx * az;
    positions[3 * index + 2] = tz + z + qw * az + qx * ay - qy * ax;
  });
  return positions;
}

function coloursOf({ colors }: Marker): Uint8Array {
  return Uint8Array.from(colors.flatMap(({ r, g, b }) => [255 * r, 255 * g, 255 * b]));
}
