/** Pictures of a camera, plain or compressed, with detections drawn over them. */

import "./image.css";
import type { Dispose, Message } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { bytesText, download, rateText } from "./format";
import { type Box, boxesOf, type RawImage, toRgba } from "./image_decoding";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";
import { topicSelect, type TopicSelect } from "./topic_select";

const RATES_HZ = [1, 5, 10, 30];
const IMAGE = /\/(Image|CompressedImage)$/;
const COMPRESSED = "/compressed";
const DETECTIONS = /\/(Detection2DArray|Detection2D)$/;

class ImagePanel implements PanelInstance {
  readonly #image: TopicSelect;
  readonly #overlay: TopicSelect;
  readonly #canvas = h("canvas", { class: "image-canvas", role: "img" });
  readonly #boxes = h("canvas", { class: "image-boxes", "aria-hidden": "true" });
  readonly #frame: HTMLElement;
  readonly #facts = h("span", { class: "hint number image-facts" });
  readonly #empty = emptyState("image", "No image", "A camera's topic appears in the list as soon as it is published.");
  readonly #subscriptions: Dispose[] = [];
  readonly #rate: HTMLSelectElement;
  #pixels: ImageData | null = null;
  #message: Message | null = null;
  #detections: readonly Box[] = [];
  readonly #offTopics: Dispose;
  /** The topic that is subscribed to. */
  #from = "";
  #isVisible = false;
  #isDecoding = false;
  #failure = "";

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    const { connection, settings } = context;
    this.#image = topicSelect(connection, { label: "Image topic", value: settings.get<string>("topic", ""), takesFirst: true,
      accepts: ({ name, type }) => IMAGE.test(type) && !this.#isCompressedTwin(name),
      onChange: (topic) => {
        settings.set("topic", topic);
        nextFrame(() => this.#subscribe());
      } });
    this.#overlay = topicSelect(connection, { label: "Detections", value: settings.get<string>("detections", ""), none: "No detections",
      accepts: ({ type }) => DETECTIONS.test(type),
      onChange: (topic) => {
        settings.set("detections", topic);
        nextFrame(() => this.#subscribe());
      } });
    this.#rate = h("select", { "aria-label": "Most images per second", title: "Most images per second", onchange: () => {
      settings.set("rateHz", Number(this.#rate.value));
      this.#subscribe();
    } });
    this.#rate.append(...RATES_HZ.map((rate) => new Option(`${rate} Hz`, String(rate))));
    this.#rate.value = String(settings.get<number>("rateHz", 10));
    const save = h("button", { class: "bare", title: "Save as PNG", "aria-label": "Save as PNG", onclick: () => this.#save() }, icon("download"));
    this.#frame = h("div", { class: "image-frame" }, this.#canvas, this.#boxes);
    container.append(h("div", { class: "panel" }, h("div", { class: "bar" }, this.#image.element, this.#overlay.element, this.#rate, save),
      h("div", { class: "body image-body" }, this.#frame, this.#facts, this.#empty.element)));
    // The server's compressed pictures can be announced later than the panel is opened.
    this.#offTopics = connection.on("topics", () => {
      if (this.#isVisible && this.#image.value && this.#source(this.#image.value) !== this.#from) nextFrame(() => this.#subscribe());
    });
    this.#showEmpty();
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    this.#subscribe();
  }

  dispose = (): void => {
    this.#end();
    this.#offTopics();
    this.#image.dispose();
    this.#overlay.dispose();
  };

  /** The server's compressed pictures of a camera, if it makes them. */
  #source(topic: string): string {
    const twin = this.context.connection.topics.get(topic + COMPRESSED);
    return twin?.isPublished && /\/Image$/.test(this.context.connection.topics.get(topic)?.type ?? "") ? twin.name : topic;
  }

  #isCompressedTwin(name: string): boolean {
    return name.endsWith(COMPRESSED) && this.context.connection.topics.get(name.slice(0, -COMPRESSED.length))?.isPublished === true;
  }

  #end(): void {
    for (const end of this.#subscriptions.splice(0)) end();
  }

  #subscribe(): void {
    this.#end();
    const { connection } = this.context;
    const [topic, overlay] = [this.#image.value, this.#overlay.value];
    this.context.setTitle(topic || "Image");
    if (this.#message && this.#message.topic !== this.#source(topic)) this.#message = null;
    if (!overlay) this.#detections = [];
    if (this.#isVisible && topic) {
      const rateHz = Number(this.#rate.value);
      this.#from = this.#source(topic);
      this.#subscriptions.push(connection.subscribe(this.#from, { rateHz }, (message) => {
        this.#message = message;
        nextFrame(this.#draw);
      }));
      if (overlay) this.#subscriptions.push(connection.subscribe(overlay, { rateHz }, ({ value }) => {
        this.#detections = boxesOf(value);
        nextFrame(this.#drawBoxes);
      }));
    }
    this.#showEmpty();
    this.#drawBoxes();
  }

  readonly #draw = (): void => {
    const message = this.#message;
    if (!message || this.#isDecoding) return;
    try {
      if (message.type.endsWith("/CompressedImage")) void this.#drawCompressed(message);
      else this.#drawRaw(message.value as RawImage);
    } catch (error) {
      this.#fail(error);
    }
    this.#showEmpty();
    this.#showFacts(message);
  };

  #drawRaw(image: RawImage): void {
    if (this.#pixels?.width !== image.width || this.#pixels.height !== image.height) {
      if (image.width === 0 || image.height === 0) throw new Error("the image is empty");
      this.#pixels = new ImageData(image.width, image.height);
      this.#resize(image.width, image.height);
    }
    toRgba(image, this.#pixels.data);
    this.#canvas.getContext("2d")?.putImageData(this.#pixels, 0, 0);
    this.#failure = "";
  }

  async #drawCompressed(message: Message): Promise<void> {
    const { data, format } = message.value as { data: Uint8Array<ArrayBuffer>; format: string };
    this.#isDecoding = true;
    try {
      const kind = /png/.test(format) ? "image/png" : /webp/.test(format) ? "image/webp" : "image/jpeg";
      const bitmap = await createImageBitmap(new Blob([data], { type: kind }));
      if (this.#canvas.width !== bitmap.width || this.#canvas.height !== bitmap.height) this.#resize(bitmap.width, bitmap.height);
      this.#canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
      bitmap.close();
      this.#failure = "";
    } catch {
      this.#fail(new Error(`the format ${format || "(none)"} cannot be decoded`));
    } finally {
      this.#isDecoding = false;
      this.#showFacts(message);
      if (this.#message !== message) nextFrame(this.#draw); // one came meanwhile
    }
  }

  #resize(width: number, height: number): void {
    for (const canvas of [this.#canvas, this.#boxes]) Object.assign(canvas, { width, height });
    this.#frame.style.aspectRatio = `${width} / ${height}`;
    this.#frame.style.setProperty("--ratio", String(width / height));
    this.#canvas.setAttribute("aria-label", `Image of ${this.#image.value}`);
    this.#drawBoxes();
  }

  readonly #drawBoxes = (): void => {
    const context = this.#boxes.getContext("2d");
    if (!context) return;
    const scale = Math.max(1, this.#boxes.width / 480);
    context.clearRect(0, 0, this.#boxes.width, this.#boxes.height);
    context.font = `600 ${12 * scale}px system-ui`;
    context.lineWidth = 2 * scale;
    const colour = this.context.theme.colour("thread");
    for (const box of this.#detections) {
      context.save();
      context.translate(box.x, box.y);
      context.rotate(box.angle);
      context.strokeStyle = colour;
      context.strokeRect(-box.width / 2, -box.height / 2, box.width, box.height);
      if (box.label) {
        const width = context.measureText(box.label).width + 8 * scale;
        // Above the box, or in it at the image's upper edge.
        const top = -box.height / 2 - (box.y - box.height / 2 < 17 * scale ? 0 : 17 * scale);
        context.fillStyle = colour;
        context.fillRect(-box.width / 2 - scale, top, width, 17 * scale);
        context.fillStyle = this.context.theme.colour("on-thread");
        context.fillText(box.label, -box.width / 2 + 3 * scale, top + 12.5 * scale);
      }
      context.restore();
    }
  };

  #fail(error: unknown): void {
    this.#failure = error instanceof Error ? error.message : String(error);
    this.#showEmpty();
  }

  #showFacts(message: Message): void {
    const statistics = this.context.connection.statistics(message.topic);
    const found = this.#detections.length > 0 ? ` · ${this.#detections.length} detection${this.#detections.length > 1 ? "s" : ""}` : "";
    const stream = statistics && statistics.rateHz !== null ? ` · ${rateText(statistics.rateHz)} Hz · ${bytesText(statistics.bytesPerS)}/s` : "";
    setText(this.#facts, `${this.#canvas.width} × ${this.#canvas.height}${stream}${found}`);
  }

  #showEmpty(): void {
    const isEmpty = this.#message === null || this.#failure !== "";
    this.#empty.element.hidden = !isEmpty;
    this.#frame.hidden = isEmpty;
    this.#facts.hidden = isEmpty;
    if (!isEmpty) return;
    const topic = this.#image.value;
    if (this.#failure) this.#empty.set("Cannot be displayed", this.#failure);
    else if (!topic) this.#empty.set("No image", "A camera's topic appears in the list as soon as it is published.");
    else if (!this.context.connection.topics.get(topic)?.isPublished) this.#empty.set("Not published", `No node publishes ${topic} now.`);
    else this.#empty.set("Waiting for an image", `${topic} has a publisher; its first image is on the way.`);
  }

  #save(): void {
    if (!this.#message) return;
    const canvas = h("canvas", { width: this.#canvas.width, height: this.#canvas.height });
    const context = canvas.getContext("2d");
    context?.drawImage(this.#canvas, 0, 0);
    context?.drawImage(this.#boxes, 0, 0);
    canvas.toBlob((blob) => blob && download("navette-image.png", blob, "image/png"));
  }
}

registerPanel({
  id: "image",
  title: "Image",
  icon: "image",
  place: "right",
  isMultiple: true,
  hint: "Pictures of a camera with detections.",
  create: (container, context) => new ImagePanel(container, context),
});
