/** Draws the scene in 3D with three.js; loaded when 3D is first wanted. */

import {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry, DataTexture,
  DirectionalLight, DoubleSide, Group, Line, LineBasicMaterial, LineLoop, LineSegments, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, Matrix4, NearestFilter, Object3D, PerspectiveCamera, PlaneGeometry, Points, PointsMaterial, Quaternion, Scene, ShapeUtils,
  SphereGeometry, Sprite, SpriteMaterial, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
  type Material, type Texture,
} from "three";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Transform } from "../transforms/transform";
import { PointLayer } from "./point_layer";
import { rgba, type Colour, type Label, type Lines, type Points as PointSet, type Primitive, type Raster, type Sign, type Solid } from "./primitives";
import type { DrawItem, Ray, Renderer, Viewpoint } from "./renderer";
import { isSoftwareGl } from "./software_gl";
import { FIELD_DEG } from "./viewing";

/** Slightly above what was drawn before, so that flat things do not flicker through each other. */
const LAYER_M = 0.002;
/** Pixels per metre at which signs have their size; they scale with the view. */
const MOST_RATIO = 1.5;

const ONES = new Vector3(1, 1, 1);

/** Without a graphics card, a view that moves over so many points has half as many pixels a side, until it stands. */
const MANY_POINTS = 5000;
const COARSE = 0.5;
const STANDS_MS = 250;
const FOLLOWING_PX = 12;

/** An object of three.js and what is freed with it. */
interface Built {
  readonly object: Object3D;
  readonly materials: Material[];
  /** A sign keeps its size on the screen: pixels, or 0. */
  readonly sizePx: number;
  /** Take over what has changed in the primitive. */
  readonly update?: () => void;
}

export class ThreeRenderer implements Renderer {
  readonly #gl: WebGLRenderer;
  /** Where WebGL is drawn by the processor. */
  readonly #points: PointLayer | null;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(FIELD_DEG, 1, 0.1, 2000);
  readonly #built = new Map<Primitive, Built>();
  #width = 0;
  #height = 0;
  #ratio = 0;
  #view: Viewpoint | null = null;
  #movedMs = -Infinity;
  #pointCount = 0;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly invalidate: () => void,
  ) {
    this.#points = isSoftwareGl() ? new PointLayer() : null;
    this.#gl = new WebGLRenderer({ canvas, antialias: this.#points === null, powerPreference: "high-performance" });
    if (this.#points) this.#scene.add(this.#points.object);
    this.#camera.up.set(0, 0, 1);
    this.#scene.add(new AmbientLight(0xffffff, 2));
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(0.5, -0.8, 1.6);
    this.#scene.add(sun);
    canvas.addEventListener("webglcontextrestored", invalidate);
  }

  draw(items: readonly DrawItem[], viewpoint: Viewpoint, background: string): void {
    this.#note(viewpoint);
    this.#fit();
    this.#place(viewpoint);
    this.#pointCount = 0;
    this.#scene.background = colourOf(background);
    const used = new Set<Primitive>();
    const perPx = 1 / viewpoint.scale;
    this.#points?.begin(this.#camera, this.canvas.width, this.canvas.height);
    items.forEach((item, order) => {
      try {
        this.#drawItem(item, order, perPx, used);
      } catch (error) {
        item.fail(error);
      }
    });
    for (const [primitive, built] of this.#built) {
      if (used.has(primitive)) continue;
      this.#scene.remove(built.object);
      free(built);
      this.#built.delete(primitive);
    }
    this.#points?.end();
    this.#gl.render(this.#scene, this.#camera);
  }

  #drawItem({ part, fixed_T_part, opacity }: DrawItem, order: number, perPx: number, used: Set<Primitive>): void {
    const lift = LAYER_M * order * Math.min(1, 20 * perPx);
    for (const primitive of part.primitives) {
      if (used.has(primitive)) continue;
      if (this.#points && primitive.kind === "points" && opacity * rgba(primitive.colour)[3] === 1) {
        this.#pointCount += primitive.positions.length / 3;
        this.#points.draw(primitive, matrixOf(fixed_T_part, lift), primitive.sizePx * this.#gl.getPixelRatio());
        continue;
      }
      used.add(primitive);
      const built = this.#objectOf(primitive);
      if (!built) continue;
      built.update?.();
      moveTo(built.object, fixed_T_part, lift);
      built.object.renderOrder = order;
      if (built.sizePx > 0) built.object.children[0]?.scale.setScalar(built.sizePx * perPx);
      for (const material of built.materials) fade(material, opacity);
    }
  }

  ray(viewpoint: Viewpoint, px: number, py: number): Ray {
    this.#fit();
    this.#place(viewpoint);
    const { x, y, z } = this.#camera.position;
    const far = new Vector3((2 * px) / this.#width - 1, 1 - (2 * py) / this.#height, 0.5).unproject(this.#camera);
    const direction = far.sub(this.#camera.position).normalize();
    return { origin: [x, y, z], direction: [direction.x, direction.y, direction.z], metresPerPx: 1 / viewpoint.scale };
  }

  project(viewpoint: Viewpoint, point: readonly [number, number, number]): [number, number] | null {
    this.#place(viewpoint);
    const place = new Vector3(...point).project(this.#camera);
    return place.z > 1 ? null : [((place.x + 1) / 2) * this.#width, ((1 - place.y) / 2) * this.#height];
  }

  dispose(): void {
    for (const built of this.#built.values()) free(built);
    this.#built.clear();
    clearTimeout(this.#timer);
    this.#points?.dispose();
    this.#gl.dispose();
    this.#gl.forceContextLoss();
  }

  get #isCoarse(): boolean {
    return this.#points !== null && this.#pointCount > MANY_POINTS && performance.now() - this.#movedMs < STANDS_MS;
  }

  /** Note when the view moves; draw in full when it stands. */
  #note(viewpoint: Viewpoint): void {
    const before = this.#view;
    this.#view = { ...viewpoint };
    if (!before || !isFarFrom(before, viewpoint)) return;
    this.#movedMs = performance.now();
    clearTimeout(this.#timer);
    this.#timer = setTimeout(this.invalidate, STANDS_MS + 50);
  }

  #fit(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = Math.min(devicePixelRatio || 1, MOST_RATIO) * (this.#isCoarse ? COARSE : 1);
    if (width === this.#width && height === this.#height && ratio === this.#ratio) return;
    [this.#width, this.#height, this.#ratio] = [Math.max(1, width), Math.max(1, height), ratio];
    this.#gl.setPixelRatio(ratio);
    this.#gl.setSize(this.#width, this.#height, false);
    this.#camera.aspect = this.#width / this.#height;
    this.#camera.updateProjectionMatrix();
  }

  /** As far away that the middle has the scale of the viewpoint. */
  #place({ centre: [x, y], scale, azimuth, elevation }: Viewpoint): void {
    const far = this.#height / scale / (2 * Math.tan((FIELD_DEG * Math.PI) / 360));
    const flat = far * Math.cos(elevation);
    this.#camera.position.set(x + flat * Math.cos(azimuth), y + flat * Math.sin(azimuth), far * Math.sin(elevation));
    this.#camera.near = Math.max(0.05, far / 200);
    this.#camera.far = far * 40;
    this.#camera.lookAt(x, y, 0);
    this.#camera.updateProjectionMatrix();
    this.#camera.updateMatrixWorld();
  }

  #objectOf(primitive: Primitive): Built | null {
    const known = this.#built.get(primitive);
    if (known) return known;
    const built = build(primitive);
    if (!built) return null;
    this.#built.set(primitive, built);
    this.#scene.add(built.object);
    return built;
  }
}

/** Whether the view was turned, zoomed or moved by a hand: a view that follows the robot moves less. */
function isFarFrom(before: Viewpoint, { centre: [x, y], scale, azimuth, elevation }: Viewpoint): boolean {
  const movedPx = scale * Math.hypot(x - before.centre[0], y - before.centre[1]);
  return movedPx > FOLLOWING_PX || scale !== before.scale || azimuth !== before.azimuth || elevation !== before.elevation;
}

function build(primitive: Primitive): Built | null {
  switch (primitive.kind) {
    case "raster":
      return rasterOf(primitive);
    case "points":
      return pointsOf(primitive);
    case "lines":
      return linesOf(primitive);
    case "solid":
      return solidOf(primitive);
    case "sign":
      return signOf(primitive);
    case "label":
      return labelOf(primitive);
  }
}

/** An object whose own pose is that of its frame; `inner` is placed within. */
function wrap(inner: Object3D, pose: Transform | null, materials: Material[], sizePx = 0): Built {
  const object = new Group();
  if (pose) moveTo(inner, pose, 0);
  object.add(inner);
  return { object, materials, sizePx };
}

function rasterOf({ pose, widthM, heightM, columns, rows, pixels, changes }: Raster): Built {
  const texture = new DataTexture(new Uint8Array(pixels.buffer), columns, rows);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = texture.minFilter = NearestFilter;
  texture.needsUpdate = true;
  const material = flat({ map: texture });
  const geometry = new PlaneGeometry(widthM, heightM).translate(widthM / 2, heightM / 2, 0);
  let drawn = changes.length;
  const update = (): void => {
    if (changes.length > drawn) texture.needsUpdate = true;
    drawn = changes.length;
  };
  return { ...wrap(new Mesh(geometry, material), pose, [material]), update };
}

function pointsOf({ positions, colours, colour, sizePx }: PointSet): Built {
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
  const material = new PointsMaterial({ size: sizePx, sizeAttenuation: false });
  if (colours) {
    const linear = new Uint8Array(colours.length);
    const table = LINEAR;
    for (let index = 0; index < colours.length; index++) linear[index] = table[colours[index]!]!;
    geometry.setAttribute("color", new BufferAttribute(linear, 3, true));
    material.vertexColors = true;
  } else paint(material, colour);
  const cloud = new Points(geometry, material);
  cloud.frustumCulled = false; // its bounds would cost more than drawing it
  return wrap(cloud, null, [material]);
}

/** sRGB bytes as linear light, in bytes. */
const LINEAR = Uint8Array.from({ length: 256 }, (_, byte) => Math.round(255 * new Color().setRGB(byte / 255, 0, 0, SRGBColorSpace).r));

/** Lines of more than a pixel are strips of triangles: WebGL draws its own lines one pixel wide. */
function linesOf({ positions, mode, colour, fill, widthPx }: Lines): Built {
  const group = new Object3D(); // a Group within a group would be drawn first
  const materials: Material[] = [];
  if (widthPx > 1.2 && positions.length >= 6) {
    const material = new LineMaterial({ linewidth: widthPx });
    paint(material, colour);
    const closed = mode === "loop" ? [...positions, ...positions.subarray(0, 3)] : positions;
    group.add(mode === "segments"
      ? new LineSegments2(new LineSegmentsGeometry().setPositions(positions), material)
      : new Line2(new LineGeometry().setPositions(closed), material));
    materials.push(material);
  } else {
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
    const material = new LineBasicMaterial();
    paint(material, colour);
    const Kind = { strip: Line, loop: LineLoop, segments: LineSegments }[mode];
    group.add(new Kind(geometry, material));
    materials.push(material);
  }
  if (fill) {
    const inner = flat({ side: DoubleSide });
    paint(inner, fill);
    group.add(new Mesh(areaOf(positions), inner));
    materials.push(inner);
  }
  return wrap(group, null, materials);
}

/** Triangles of the polygon that the points enclose. */
function areaOf(positions: Float32Array): BufferGeometry {
  const corners: Vector2[] = [];
  for (let at = 0; at + 2 < positions.length; at += 3) corners.push(new Vector2(positions[at], positions[at + 1]));
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(ShapeUtils.triangulateShape(corners, []).flat());
  return geometry;
}

function solidOf({ shape, pose, size, colour, mesh }: Solid): Built {
  const material = new MeshLambertMaterial();
  paint(material, colour);
  let geometry: BufferGeometry;
  if (shape === "box") geometry = new BoxGeometry(1, 1, 1);
  else if (shape === "sphere") geometry = new SphereGeometry(0.5, 20, 14);
  else if (shape === "cylinder") geometry = new CylinderGeometry(0.5, 0.5, 1, 24).rotateX(Math.PI / 2);
  else {
    geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(mesh?.positions ?? new Float32Array(0), 3));
    geometry.computeVertexNormals();
    material.side = DoubleSide;
  }
  const body = new Mesh(geometry, material);
  body.scale.set(...size);
  return wrap(body, pose, [material]);
}

function signOf({ shape, pose, sizePx, colour }: Sign): Built {
  const material = flat({ side: DoubleSide, depthTest: false });
  paint(material, colour);
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(Float32Array.from(outlineOf(shape)), 3));
  return wrap(new Mesh(geometry, material), pose, [material], sizePx);
}

/** Triangles of a sign of size one, flat on the ground. */
function outlineOf(shape: Sign["shape"]): number[] {
  if (shape === "arrow") return [...quad(0, 0, 1, 0, 0.13), 1.02, 0, 0, 0.6, 0.3, 0, 0.6, -0.3, 0];
  if (shape === "cross") return [...quad(-0.5, -0.5, 0.5, 0.5, 0.18), ...quad(-0.5, 0.5, 0.5, -0.5, 0.18)];
  const disc = (outer: number, inner: number): number[] => {
    const numbers: number[] = [];
    for (let step = 0; step < 24; step++) {
      const [a, b] = [(2 * Math.PI * step) / 24, (2 * Math.PI * (step + 1)) / 24];
      const at = (radius: number, angle: number): number[] => [radius * Math.cos(angle), radius * Math.sin(angle), 0];
      numbers.push(...at(outer, a), ...at(outer, b), ...at(inner, b), ...at(outer, a), ...at(inner, b), ...at(inner, a));
    }
    return numbers;
  };
  if (shape === "dot") return disc(0.5, 0);
  return shape === "ring" ? disc(0.5, 0.36) : [...disc(0.5, 0.36), ...disc(0.17, 0)];
}

/** A line of some width as two triangles. */
function quad(ax: number, ay: number, bx: number, by: number, width: number): number[] {
  const length = Math.hypot(bx - ax, by - ay);
  const [nx, ny] = [(-(by - ay) / length) * (width / 2), ((bx - ax) / length) * (width / 2)];
  const [a, b, c, d] = [[ax + nx, ay + ny, 0], [ax - nx, ay - ny, 0], [bx - nx, by - ny, 0], [bx + nx, by + ny, 0]];
  return [...a, ...b, ...c, ...a, ...c, ...d];
}

function labelOf({ position: [x, y, z], text, colour, sizePx, abovePx = 6 }: Label): Built {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  const font = `600 ${2 * sizePx}px system-ui, sans-serif`;
  if (context) {
    context.font = font;
    canvas.width = Math.ceil(context.measureText(text).width) + 8;
    canvas.height = 3 * sizePx;
    context.font = font; // a new size resets it
    context.fillStyle = colour;
    context.textBaseline = "middle";
    context.fillText(text, 4, canvas.height / 2);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  const material = new SpriteMaterial({ map: texture, depthTest: false, transparent: true });
  const sprite = new Sprite(material);
  sprite.center.set(0.5, -0.1 - (abovePx - 6) / (1.5 * sizePx));
  sprite.scale.set(canvas.width / canvas.height, 1, 1);
  const holder = new Object3D();
  holder.add(sprite);
  return wrap(holder, { translation: [x, y, z], rotation: [0, 0, 0, 1] }, [material], 1.5 * sizePx);
}

function flat(options: ConstructorParameters<typeof MeshBasicMaterial>[0]): MeshBasicMaterial {
  return new MeshBasicMaterial({ transparent: true, depthWrite: false, ...options });
}

function colourOf(colour: Colour): Color {
  const [r, g, b] = rgba(colour);
  return new Color().setRGB(r / 255, g / 255, b / 255, SRGBColorSpace);
}

function paint(material: MeshBasicMaterial | MeshLambertMaterial | LineBasicMaterial | LineMaterial | PointsMaterial, colour: Colour): void {
  material.color.copy(colourOf(colour));
  material.userData["opacity"] = rgba(colour)[3];
}

function fade(material: Material, opacity: number): void {
  const total = opacity * ((material.userData["opacity"] as number | undefined) ?? 1);
  material.opacity = total;
  if (total < 1) material.transparent = true;
}

function moveTo(object: Object3D, { translation: [x, y, z], rotation }: Transform, lift: number): void {
  object.position.set(x, y, z + lift);
  object.quaternion.set(...rotation);
}

function matrixOf({ translation: [x, y, z], rotation }: Transform, lift: number): Matrix4 {
  return new Matrix4().compose(new Vector3(x, y, z + lift), new Quaternion(...rotation), ONES);
}

function free({ object, materials }: Built): void {
  object.traverse((each) => {
    if (each instanceof Mesh || each instanceof Line || each instanceof Points) (each.geometry as BufferGeometry).dispose();
  });
  for (const material of materials) {
    (material as Material & { map?: Texture | null }).map?.dispose();
    material.dispose();
  }
}
