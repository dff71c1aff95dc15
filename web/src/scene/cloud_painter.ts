/** Paints large point clouds from above: each pixel shows its highest point. */

import { apply, type Transform } from "../transforms/transform";
import { rgba, type Points } from "./primitives";

export class CloudPainter {
  #image: ImageData | null = null;
  #pixels = new Uint32Array(0);
  #highest = new Float32Array(0);
  readonly #canvas = document.createElement("canvas");

  paint(context: CanvasRenderingContext2D, points: Points, pose: Transform): void {
    const { width, height } = context.canvas;
    const { a: scale, e: left, f: top } = context.getTransform();
    this.#prepare(width, height);
    const { positions, colours } = points;
    const [pixels, highest] = [this.#pixels, this.#highest];
    const size = Math.max(1, Math.round(points.sizePx * (devicePixelRatio || 1) * 0.7));
    const [r, g, b] = rgba(points.colour);
    const plain = ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
    const [ox, oy, oz] = apply(pose, [0, 0, 0]);
    const [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [apply(pose, [1, 0, 0]), apply(pose, [0, 1, 0]), apply(pose, [0, 0, 1])];
    for (let at = 0; at + 2 < positions.length; at += 3) {
      const [x, y, z] = [positions[at]!, positions[at + 1]!, positions[at + 2]!];
      const fx = ox + (ax - ox) * x + (bx - ox) * y + (cx - ox) * z;
      const fy = oy + (ay - oy) * x + (by - oy) * y + (cy - oy) * z;
      const fz = oz + (az - oz) * x + (bz - oz) * y + (cz - oz) * z;
      const column = Math.round(left + scale * fx - size / 2);
      const row = Math.round(top - scale * fy - size / 2);
      if (column < 0 || row < 0 || column + size > width || row + size > height) continue;
      const word = colours ? ((255 << 24) | (colours[at + 2]! << 16) | (colours[at + 1]! << 8) | colours[at]!) >>> 0 : plain;
      for (let line = row; line < row + size; line++) {
        for (let pixel = line * width + column; pixel < line * width + column + size; pixel++) {
          if (fz > highest[pixel]!) {
            highest[pixel] = fz;
            pixels[pixel] = word;
          }
        }
      }
    }
    this.#canvas.getContext("2d")?.putImageData(this.#image!, 0, 0);
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.#canvas, 0, 0);
    context.restore();
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
