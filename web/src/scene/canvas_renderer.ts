/** Draws the scene from above on a canvas, without a graphics card. */

import { apply, compose, yawOf, type Transform, type Vector } from "../transforms/transform";
import { CloudPainter, type PlacedCloud } from "./cloud_painter";
import { convexHull } from "./hull";
import { rgba, type Label, type Lines, type Points, type Primitive, type Raster, type Sign, type Solid } from "./primitives";
import { fitCanvas, type DrawItem, type Ray, type Renderer, type Viewpoint } from "./renderer";
import { cornersOf } from "./solids";

/** More points than this are painted as pixels. */
const MANY_POINTS = 3000;

interface Image {
  readonly canvas: HTMLCanvasElement;
  /** Number of the raster's changes that it contains. */
  changes: number;
}

export class CanvasRenderer implements Renderer {
  readonly #context: CanvasRenderingContext2D;
  readonly #clouds = new CloudPainter();
  readonly #images = new WeakMap<Raster, Image>();
  #scale = 1;
  #sky = "";

  constructor(readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext("2d", { alpha: false });
    if (!context) throw new Error("this browser has no 2D canvas");
    this.#context = context;
  }

  draw(items: readonly DrawItem[], { centre, scale }: Viewpoint, background: string): void {
    const ratio = devicePixelRatio || 1;
    fitCanvas(this.canvas, ratio);
    const context = this.#context;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.#scale = scale;
    this.#sky = background;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 1;
    context.fillStyle = background;
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    // Metres, y up.
    const [a, e] = [ratio * scale, ratio * (width / 2 - centre[0] * scale)];
    context.setTransform(a, 0, 0, -a, e, ratio * (height / 2 + centre[1] * scale));
    this.#drawAll(items);
  }

  /** In order; clouds that follow each other, such as those that decay, are one picture. */
  #drawAll(items: readonly DrawItem[]): void {
    let clouds: (PlacedCloud & { item: DrawItem })[] = [];
    let opacity = 1;
    const paintClouds = (): void => {
      const picture = clouds;
      clouds = [];
      try {
        if (picture.length > 0) this.#clouds.paint(this.#context, picture);
      } catch (error) {
        for (const { item } of picture) item.fail(error);
      }
    };
    for (const item of items) {
      if (item.opacity !== opacity) paintClouds();
      this.#context.globalAlpha = opacity = item.opacity;
      try {
        for (const primitive of item.part.primitives) {
          if (isCloud(primitive)) clouds.push({ points: primitive, fixed_T_points: item.fixed_T_part, item });
          else {
            paintClouds();
            this.#draw(primitive, item.fixed_T_part);
          }
        }
      } catch (error) {
        item.fail(error);
      }
    }
    paintClouds();
  }

  ray({ centre, scale }: Viewpoint, px: number, py: number): Ray {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const x = centre[0] + (px - width / 2) / scale;
    const y = centre[1] - (py - height / 2) / scale;
    return { origin: [x, y, 1000], direction: [0, 0, -1], metresPerPx: 1 / scale };
  }

  project({ centre, scale }: Viewpoint, [x, y]: readonly [number, number, number]): [number, number] {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return [width / 2 + (x - centre[0]) * scale, height / 2 - (y - centre[1]) * scale];
  }

  dispose(): void {
    this.canvas.width = this.canvas.height = 0;
  }

  #draw(primitive: Primitive, pose: Transform): void {
    switch (primitive.kind) {
      case "raster":
        return this.#raster(primitive, pose);
      case "points":
        return this.#points(primitive, pose);
      case "lines":
        return this.#lines(primitive, pose);
      case "solid":
        return this.#solid(primitive, pose);
      case "sign":
        return this.#sign(primitive, pose);
      case "label": {
        const [x, y] = apply(pose, primitive.position);
        return this.#label(x, y, primitive);
      }
    }
  }

  #raster(raster: Raster, pose: Transform): void {
    const context = this.#context;
    const { translation: [x, y], rotation } = compose(pose, raster.pose);
    const image = this.#image(raster); // fails for a raster without cells: before the state is saved
    context.save();
    context.translate(x, y);
    context.rotate(yawOf(rotation));
    context.imageSmoothingEnabled = false;
    context.drawImage(image, 0, 0, raster.widthM, raster.heightM);
    context.restore();
  }

  #image(raster: Raster): HTMLCanvasElement {
    const { columns, rows, changes } = raster;
    let image = this.#images.get(raster);
    if (image && image.changes === changes.length) return image.canvas;
    const pixels = new ImageData(raster.pixels, columns, rows);
    if (!image) {
      const canvas = document.createElement("canvas");
      canvas.width = columns;
      canvas.height = rows;
      canvas.getContext("2d")?.putImageData(pixels, 0, 0);
      this.#images.set(raster, (image = { canvas, changes: changes.length }));
    }
    const context = image.canvas.getContext("2d");
    for (const { x, y, width, height } of changes.slice(image.changes)) context?.putImageData(pixels, 0, 0, x, y, width, height);
    image.changes = changes.length;
    return image.canvas;
  }

  #points(points: Points, pose: Transform): void {
    const context = this.#context;
    const count = points.positions.length / 3;
    const radius = points.sizePx / 2 / this.#scale;
    context.fillStyle = points.colour;
    const plane = planeOf(pose);
    for (let index = 0; index < count; index++) {
      const [x, y] = plane(points.positions, 3 * index);
      if (points.colours) {
        const at = 3 * index;
        context.fillStyle = `rgb(${points.colours[at]!} ${points.colours[at + 1]!} ${points.colours[at + 2]!})`;
      }
      context.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
    }
  }

  #lines(lines: Lines, pose: Transform): void {
    const context = this.#context;
    const plane = planeOf(pose);
    const isSegments = lines.mode === "segments";
    context.beginPath();
    for (let at = 0; at + 2 < lines.positions.length; at += 3) {
      const [x, y] = plane(lines.positions, at);
      if (at === 0 || (isSegments && at % 6 === 0)) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
    if (lines.mode === "loop") context.closePath();
    if (lines.fill) {
      context.fillStyle = lines.fill;
      context.fill();
    }
    context.strokeStyle = lines.colour;
    context.lineWidth = lines.widthPx / this.#scale;
    context.lineJoin = "round";
    context.setLineDash(lines.isDashed ? [6 / this.#scale, 5 / this.#scale] : []);
    context.stroke();
    context.setLineDash([]);
  }

  /** The outline of a body from above. */
  #solid(solid: Solid, pose: Transform): void {
    const context = this.#context;
    const hull = convexHull(cornersOf(solid, pose));
    if (hull.length < 3) return;
    context.beginPath();
    hull.forEach(([x, y], index) => (index ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.closePath();
    context.fillStyle = solid.colour;
    context.fill();
    const [r, g, b] = rgba(solid.colour);
    context.strokeStyle = `rgb(${0.7 * r} ${0.7 * g} ${0.7 * b})`;
    context.lineWidth = 1 / this.#scale;
    context.stroke();
  }

  #sign({ shape, pose, sizePx, colour }: Sign, above: Transform): void {
    const context = this.#context;
    const { translation: [x, y], rotation } = compose(above, pose);
    const r = sizePx / 2 / this.#scale;
    context.save();
    context.translate(x, y);
    context.rotate(yawOf(rotation));
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 2.5 / this.#scale;
    context.lineCap = "round";
    context.beginPath();
    if (shape === "cross") {
      context.moveTo(-r, -r);
      context.lineTo(r, r);
      context.moveTo(-r, r);
      context.lineTo(r, -r);
      context.stroke();
    } else if (shape === "arrow") {
      const tip = 2 * r;
      context.moveTo(0, 0);
      context.lineTo(tip, 0);
      context.moveTo(0.62 * tip, 0.28 * tip);
      context.lineTo(tip, 0);
      context.lineTo(0.62 * tip, -0.28 * tip);
      context.stroke();
    } else if (shape === "dot") {
      context.arc(0, 0, r, 0, 7);
      context.fill();
    } else {
      context.arc(0, 0, r, 0, 7);
      context.stroke();
      context.beginPath();
      context.arc(0, 0, shape === "goal" ? 0.34 * r : 0.001, 0, 7);
      context.fill();
    }
    context.restore();
  }

  #label(x: number, y: number, { text, colour, sizePx, abovePx = 6 }: Label): void {
    const context = this.#context;
    context.save();
    context.translate(x, y);
    context.scale(1 / this.#scale, -1 / this.#scale);
    context.font = `500 ${sizePx}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.strokeStyle = this.#sky;
    context.strokeText(text, 0, -abovePx);
    context.fillStyle = colour;
    context.fillText(text, 0, -abovePx);
    context.restore();
  }
}

function isCloud(primitive: Primitive): primitive is Points {
  return primitive.kind === "points" && primitive.positions.length > 3 * MANY_POINTS;
}

/** A function that turns the point at an index of the array to the plane. */
function planeOf(pose: Transform): (positions: Float32Array, at: number) => [number, number] {
  const [ox, oy] = pose.translation;
  const axis = (vector: Vector): Vector => {
    const [x, y, z] = apply(pose, vector);
    return [x - ox, y - oy, z];
  };
  const [[ax, ay], [bx, by], [cx, cy]] = [axis([1, 0, 0]), axis([0, 1, 0]), axis([0, 0, 1])];
  return (positions, at) => {
    const [x, y, z] = [positions[at]!, positions[at + 1]!, positions[at + 2]!];
    return [ox + ax * x + bx * y + cx * z, oy + ay * x + by * y + cy * z];
  };
}
