/** Bodies from a URDF in a std_msgs/String: the robot's links, or the world's shapes. */

import { Display, withProblem, type DisplayStatus, type DisplayTraits, type Surroundings } from "../display";
import { faded, type Part, type Primitive, colourOf } from "../primitives";
import { fromRollPitchYaw, type Transform, type Vector } from "../../transforms/transform";
import { MeshStore } from "./meshes";

interface Visual {
  readonly link: string;
  /** Of the shape itself; empty without one. */
  readonly name: string;
  readonly pose: Transform;
  readonly shape: "box" | "sphere" | "cylinder" | "mesh";
  readonly size: Vector;
  readonly colour: string | null;
  readonly uri: string;
}

export class ModelDisplay extends Display<{ data: string }> {
  #visuals: Visual[] = [];
  #text = "";
  readonly #meshes: MeshStore;

  constructor(around: Surroundings, topic: string, type: string, traits: DisplayTraits) {
    super(around, topic, type, traits);
    this.#meshes = new MeshStore(around.connection, () => this.restyle());
  }

  protected override take(value: { data: string }): void {
    if (value.data === this.#text) return;
    this.#text = value.data;
    this.#visuals = readUrdf(value.data);
  }

  override clear(): void {
    this.#visuals = [];
    this.#text = "";
    super.clear();
  }

  protected override build(): Part[] {
    const byLink = new Map<string, Map<Primitive, Visual>>();
    for (const visual of this.#visuals) {
      const primitive = this.#primitive(visual);
      const drawn = byLink.get(visual.link) ?? new Map<Primitive, Visual>();
      if (primitive) byLink.set(visual.link, drawn.set(primitive, visual));
    }
    return [...byLink].map(([frame, drawn]) => ({
      frame,
      primitives: [...drawn.keys()],
      about: (primitive) => aboutVisual(drawn.get(primitive)),
    }));
  }

  #primitive({ pose, shape, size, colour: own, uri }: Visual): Primitive | null {
    // The ground of a world would cover the map.
    if (shape === "box" && size[0] * size[1] > 900 && size[2] < 0.1) return null;
    const colour = own ?? faded(this.colour, 0.8);
    if (shape !== "mesh") return { kind: "solid", shape, pose, size, colour };
    const mesh = this.#meshes.get(uri);
    return mesh && { kind: "solid", shape, pose, size, colour, mesh };
  }

  override status(): DisplayStatus {
    return withProblem(super.status(), this.#meshes.problem);
  }

  protected override detail(): string {
    const links = new Set(this.#visuals.map(({ link }) => link)).size;
    const count = this.#visuals.length;
    return count === 0 ? "no visual shapes" : `${count} ${count === 1 ? "shape" : "shapes"}${links > 1 ? ` of ${links} links` : ""}`;
  }
}

/** What a body is: its name, else its link, and its shape with its size. */
function aboutVisual(visual: Visual | undefined): [string, string][] {
  if (!visual) return [];
  const { link, name, shape, size: [x, y, z], uri } = visual;
  const length = (metres: number): string => String(Number(metres.toFixed(2)));
  const sizes = {
    box: `box, ${length(x)} × ${length(y)} × ${length(z)} m`,
    cylinder: `cylinder, ⌀ ${length(x)} m, ${length(z)} m high`,
    sphere: `sphere, ⌀ ${length(x)} m`,
    mesh: uri.split("/").at(-1) ?? "mesh",
  };
  return [name ? ["name", name] : ["link", link], ["shape", sizes[shape]]];
}

/** The visual shapes of a URDF; XACRO macros are not expanded. */
export function readUrdf(text: string): Visual[] {
  const document = new DOMParser().parseFromString(text, "text/xml");
  const materials = new Map<string, string>();
  for (const material of document.querySelectorAll("robot > material")) {
    const colour = readColour(material);
    if (colour) materials.set(material.getAttribute("name") ?? "", colour);
  }
  const visuals: Visual[] = [];
  for (const link of document.querySelectorAll("robot > link")) {
    for (const visual of link.querySelectorAll("visual")) {
      const found = readVisual(visual, link.getAttribute("name") ?? "", materials);
      if (found) visuals.push(found);
    }
  }
  return visuals;
}

function readVisual(visual: Element, link: string, materials: Map<string, string>): Visual | null {
  const origin = visual.querySelector("origin");
  const [x, y, z] = numbers(origin?.getAttribute("xyz"), [0, 0, 0]);
  const [roll, pitch, yaw] = numbers(origin?.getAttribute("rpy"), [0, 0, 0]);
  const pose = { translation: [x, y, z], rotation: fromRollPitchYaw(roll, pitch, yaw) } as const;
  const material = visual.querySelector("material");
  const colour = (material && readColour(material)) ?? materials.get(material?.getAttribute("name") ?? "") ?? null;
  const shape = visual.querySelector("geometry")?.firstElementChild;
  const number = (name: string): number => Number(shape?.getAttribute(name) ?? 0);
  const common = { link, name: visual.getAttribute("name") ?? "", pose, colour, uri: "" };
  switch (shape?.tagName) {
    case "box":
      return { ...common, shape: "box", size: numbers(shape.getAttribute("size"), [1, 1, 1]) };
    case "cylinder":
    case "capsule":
      return { ...common, shape: "cylinder", size: [2 * number("radius"), 2 * number("radius"), number("length")] };
    case "sphere":
      return { ...common, shape: "sphere", size: [2 * number("radius"), 2 * number("radius"), 2 * number("radius")] };
    case "mesh":
      return { ...common, shape: "mesh", size: numbers(shape.getAttribute("scale"), [1, 1, 1]), uri: shape.getAttribute("filename") ?? "" };
    default:
      return null;
  }
}

function readColour(material: Element): string | null {
  const text = material.querySelector("color")?.getAttribute("rgba");
  if (!text) return null;
  const [r = 0.5, g = 0.5, b = 0.5, a = 1] = text.trim().split(/\s+/).map(Number);
  return colourOf(r, g, b, a);
}

function numbers(text: string | null | undefined, otherwise: Vector): Vector {
  const [x, y, z] = (text ?? "").trim().split(/\s+/).map(Number);
  return [x, y, z].every((value) => Number.isFinite(value)) ? [x!, y!, z!] : otherwise;
}
