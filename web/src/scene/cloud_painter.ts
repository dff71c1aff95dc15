/** Paints large point clouds from above: each pixel shows its highest point. */

import { apply, type Transform } from "../transforms/transform";
import { rgba, type Points } from "./primitives";

export interface PlacedCloud {
  readonly points: Points;
  readonly fixed_T_points: Transform;
}

export class CloudPainter {
  #image: ImageData | null = null;
  #pixels = new Uint32Array(0);
  #highest = new Float32Array(0);
  #painted: readonly Points[] = [];
  #key = "";
  readonly #canvas = document.createElement("canvas");

  /** Clouds that are painted already, in the same places, are only copied. */
  paint(context: CanvasRenderingContext2D, clouds: readonly PlacedCloud[]): void {
    const { width, height } = context.canvas;
    const { a: scale, e: left, f: top } = context.getTransform();
    const places = clouds.map(({ points, fixed_T_points: { translation, rotation } }) => [points.sizePx, points.colour, ...translation, ...rotation].join(" "));
    const key = [width, height, scale, left, top, ...places].join(" ");
    const isSame = key === this.#key && clouds.every(({ points }, index) => points === this.#painted[index]);
    if (!isSame) {
      this.#prepare(width, height);
      for (const { points, fixed_T_points } of clouds) this.#fill(points, fixed_T_points, scale, left, top);
      this.#canvas.getContext("2d")?.putImageData(this.#image!, 0, 0);
      [this.#painted, this.#key] = [clouds.map(({ points }) => points), key];
    }
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.#canvas, 0, 0);
    context.restore();
  }

  /** Without arrays in the loop: each would be an object per point. */
  #fill({ positions, colours, sizePx, colour }: Points, pose: Transform, scale: number, left: number, top: number): void {
    const { width, height } = this.#image!;
    const [pixels, highest] = [this.#pixels, this.#highest];
    const size = Math.max(1, Math.round(sizePx * (devicePixelRatio || 1) * 0.7));
    const [r, g, b] = rgba(colour);
    const plain = ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
    const [ox, oy, oz] = apply(pose, [0, 0, 0]);
    const [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [apply(pose, [1, 0, 0]), apply(pose, [0, 1, 0]), apply(pose, [0, 0, 1])];
    // Pixels of a point: the matrix of the pose and the view, once for all points.
    const [ux, vx, wx, shiftX] = [scale * (ax - ox), scale * (bx - ox), scale * (cx - ox), left + scale * ox - size / 2 + 0.5];
    const [uy, vy, wy, shiftY] = [-scale * (ay - oy), -scale * (by - oy), -scale * (cy - oy), top - scale * oy - size / 2 + 0.5];
    const [uz, vz, wz] = [az - oz, bz - oz, cz - oz];
    for (let at = 0; at + 2 < positions.length; at += 3) {
      const x = positions[at]!;
      const y = positions[at + 1]!;
      const z = positions[at + 2]!;
      const column = Math.floor(shiftX + ux * x + vx * y + wx * z);
      const row = Math.floor(shiftY + uy * x + vy * y + wy * z);
      if (!(column >= 0 && row >= 0 && column + size <= width && row + size <= height)) continue;
      const up = oz + uz * x + vz * y + wz * z;
      const word = colours ? ((255 << 24) | (colours[at + 2]! << 16) | (colours[at + 1]! << 8) | colours[at]!) >>> 0 : plain;
      for (let line = row * width; line < (row + size) * width; line += width) {
        for (let pixel = line + column; pixel < line + column + size; pixel++) {
          if (up > highest[pixel]!) {
            highest[pixel] = up;
            pixels[pixel] = word;
          }
        }
      }
    }
  }

  #prepare(width: number, height: number): void {
    if (this.#image?.width !== width || this.#image.height !== height) {
      this.#canvas.width = width;
      this.#canvas.height = height;
      this.#image = new ImageData(width, height);
      this.#pixels = new Uint32Array(this.#image.data.buffer);
      this.#highest = new Float32Array(width * height);
    } else this.#pixels.fill(0);
    this.#highest.fill(-Infinity);
  }
}
