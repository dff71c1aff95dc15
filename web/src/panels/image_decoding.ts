/** Pixels of sensor_msgs/Image as RGBA, and detections to draw over them. */

export interface RawImage {
  readonly width: number;
  readonly height: number;
  readonly encoding: string;
  readonly is_bigendian: number;
  readonly step: number;
  readonly data: Uint8Array;
}

/** Offsets of red, green and blue in a pixel, and its bytes. */
const COLOURS: Readonly<Record<string, readonly [number, number, number, number]>> = {
  rgb8: [0, 1, 2, 3], bgr8: [2, 1, 0, 3], rgba8: [0, 1, 2, 4], bgra8: [2, 1, 0, 4],
  "8UC3": [2, 1, 0, 3], "8UC4": [2, 1, 0, 4], mono8: [0, 0, 0, 1], "8UC1": [0, 0, 0, 1],
};

export const ENCODINGS = [...Object.keys(COLOURS), "mono16", "16UC1", "32FC1"];

/** Convert; throws an Error that names the encoding if it is unknown. */
export function toRgba(image: RawImage, out: Uint8ClampedArray): void {
  const layout = COLOURS[image.encoding];
  if (image.data.length < image.step * image.height) throw new Error(`the image has ${image.data.length} bytes, expected ${image.step * image.height}`);
  if (layout) copyColours(image, layout, out);
  else if (["mono16", "16UC1", "32FC1"].includes(image.encoding)) copyDepth(image, out);
  else throw new Error(`encoding ${image.encoding || "(none)"} cannot be displayed; known: ${ENCODINGS.join(", ")}`);
}

function copyColours({ width, height, step, data }: RawImage, [red, green, blue, size]: readonly [number, number, number, number], out: Uint8ClampedArray): void {
  let to = 0;
  for (let row = 0; row < height; row += 1) {
    let from = row * step;
    for (let column = 0; column < width; column += 1) {
      out[to] = data[from + red]!;
      out[to + 1] = data[from + green]!;
      out[to + 2] = data[from + blue]!;
      out[to + 3] = 255;
      to += 4;
      from += size;
    }
  }
}

/** Depth and 16-bit images: near is bright, from the smallest to the largest valid value. */
function copyDepth(image: RawImage, out: Uint8ClampedArray): void {
  const { width, height, step, data, encoding } = image;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const isFloat = encoding === "32FC1";
  const little = image.is_bigendian === 0;
  const at = (row: number, column: number): number =>
    isFloat ? view.getFloat32(row * step + 4 * column, little) : view.getUint16(row * step + 2 * column, little);
  const isDepth = encoding !== "mono16";
  let [low, high] = [Infinity, -Infinity];
  for (let row = 0; row < height; row += 1) {
    for (let column = 0; column < width; column += 1) {
      const value = at(row, column);
      if (!Number.isFinite(value) || (isDepth && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  const scale = high > low ? 235 / (high - low) : 0;
  let to = 0;
  for (let row = 0; row < height; row += 1) {
    for (let column = 0; column < width; column += 1) {
      const value = at(row, column);
      const isValid = Number.isFinite(value) && !(isDepth && value <= 0);
      const grey = !isValid ? 0 : isDepth ? 255 - (value - low) * scale : 20 + (value - low) * scale;
      out[to] = out[to + 1] = out[to + 2] = grey;
      out[to + 3] = 255;
      to += 4;
    }
  }
}

export interface Box {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
  readonly angle: number;
  readonly label: string;
}

interface Detection2D {
  results?: { hypothesis?: { class_id?: string; score?: number }; id?: string; score?: number }[];
  bbox: { center: { position?: { x: number; y: number }; x?: number; y?: number; theta: number }; size_x: number; size_y: number };
  id?: string;
}

/** Boxes of vision_msgs/Detection2DArray (or one Detection2D), in pixels about their centres. */
export function boxesOf(message: unknown): Box[] {
  const { detections, bbox } = message as { detections?: Detection2D[]; bbox?: unknown };
  const list = detections ?? (bbox ? [message as Detection2D] : []);
  return list.map(({ results, bbox: { center, size_x: width, size_y: height }, id }) => {
    const best = results?.[0];
    const name = best?.hypothesis?.class_id ?? best?.id ?? id ?? "";
    const score = best?.hypothesis?.score ?? best?.score;
    return {
      x: center.position?.x ?? center.x ?? 0,
      y: center.position?.y ?? center.y ?? 0,
      width,
      height,
      angle: center.theta,
      label: [name, score === undefined ? "" : `${Math.round(100 * score)} %`].filter(Boolean).join(" "),
    };
  });
}
