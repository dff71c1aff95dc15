/** A display: a topic, or what the page computes, as primitives; with settings and a status. */

import type { Connection, Dispose, Message } from "../connection/connection";
import type { Theme } from "../theme/theme";
import type { Transform } from "../transforms/transform";
import type { TransformTree } from "../transforms/transform_tree";
import type { Part } from "./primitives";

/** Messages that remain by decay: at most so many, with so many coordinates in all. */
const MOST_KEPT = 600;
const MOST_KEPT_NUMBERS = 3_000_000;

/** What a user may change; `null`: as the display decides. */
export interface Look {
  /** Automatic: as the kind says, which may depend on 2D or 3D. */
  isVisible: boolean | null;
  colour: string | null;
  /** Pixels or metres, as the display says. */
  size: number | null;
  opacity: number;
  /** Seconds that messages remain; 0: the newest only. */
  decayS: number;
  /** One of the display's `choices`. */
  choice: string | null;
}

export const PLAIN_LOOK: Look = { isVisible: null, colour: null, size: null, opacity: 1, decayS: 0, choice: null };

export interface Surroundings {
  readonly connection: Connection;
  readonly transforms: TransformTree;
  readonly theme: Theme;
  /** The frame everything is drawn in. */
  readonly fixedFrame: string | null;
  readonly isThreeDimensional: boolean;
  /** Something changed: draw again. */
  invalidate(): void;
}

export interface DisplayStatus {
  readonly level: "ok" | "empty" | "error" | "off";
  readonly text: string;
}

/** Names, defaults and what the settings mean. */
export interface DisplayTraits {
  readonly title: string;
  /** Order of drawing and of the list; the same for all of a kind. */
  readonly order: number;
  readonly isShown: boolean | "3d";
  /** Name of a colour of the theme; without it, the colour cannot be set. */
  readonly colour?: string;
  readonly size?: { readonly value: number; readonly low: number; readonly high: number; readonly unit: string };
  readonly hasDecay?: boolean;
  readonly opacity?: number;
  readonly choices?: { readonly label: string; readonly values: readonly string[] };
  /** Most messages a second that are drawn. */
  readonly rateHz?: number;
  readonly every?: boolean;
}

export abstract class Display<T = unknown> {
  readonly id: string;
  look: Look = { ...PLAIN_LOOK };
  /** Time of the page at which the newest message came; null before the first. */
  receivedMs: number | null = null;
  protected message: T | null = null;
  #parts: Part[] | null = null;
  #kept: { parts: Part[]; untilMs: number; numbers: number }[] = [];
  #end: Dispose | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #expected: string;

  constructor(
    protected readonly around: Surroundings,
    readonly topic: string | null,
    readonly type: string,
    readonly traits: DisplayTraits,
  ) {
    this.id = topic ?? `page:${traits.title}`;
    this.#expected = type;
  }

  get isVisible(): boolean {
    const { isShown } = this.traits;
    return this.look.isVisible ?? (isShown === "3d" ? this.around.isThreeDimensional : isShown);
  }

  get opacity(): number {
    return this.look.opacity * (this.traits.opacity ?? 1);
  }

  /** Subscribe if it is shown, and end the subscription if it is not. */
  update(): void {
    const { topic } = this;
    if (topic === null) return;
    if (this.isVisible && !this.#end) {
      const { rateHz = 30, every = false } = this.traits;
      this.#end = this.around.connection.subscribe<T>(topic, { rateHz, every }, (message) => this.#take(message));
    } else if (!this.isVisible) this.dispose();
  }

  dispose(): void {
    this.#end?.();
    this.#end = null;
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.clear();
  }

  /** Forget what was received: it is from another time. */
  clear(): void {
    this.message = null;
    this.receivedMs = null;
    this.#kept = [];
    this.restyle();
  }

  /** Colours, sizes or data changed: make the primitives again when they are drawn. */
  restyle(): void {
    this.#parts = null;
    this.around.invalidate();
  }

  /** Primitives of now, and those that remain. */
  parts(): readonly Part[] {
    if (this.#parts === null) {
      try {
        this.#parts = this.build();
      } catch (error) {
        this.#parts = []; // a message of lengths that do not fit
        reportError(error);
      }
    }
    if (this.#kept.length === 0) return this.#parts;
    const now = performance.now();
    this.#kept = this.#kept.filter(({ untilMs }) => untilMs > now);
    if (this.#kept.length > 0) this.later(100, () => this.around.invalidate());
    return [...this.#kept.flatMap(({ parts }) => parts), ...this.#parts];
  }

  status(): DisplayStatus {
    const { connection, transforms, fixedFrame } = this.around;
    if (!this.isVisible) return { level: "off", text: "hidden" };
    if (this.topic !== null) {
      const known = connection.topics.get(this.topic);
      if (!known?.isPublished) return { level: "empty", text: `no node publishes ${this.topic}` };
      if (known.type !== this.#expected) return { level: "error", text: `wrong type: ${known.type}` };
      if (this.receivedMs === null) return { level: "empty", text: "no messages yet" };
    }
    const frame = this.parts()[0]?.frame;
    if (frame !== undefined && fixedFrame !== null && transforms.lookUp(fixedFrame, frame) === null) {
      return { level: "error", text: `no transform from ${frame || "a frame without a name"} to ${fixedFrame}` };
    }
    const detail = this.detail();
    return this.isEmpty() ? { level: "empty", text: detail || "the message is empty" } : { level: "ok", text: detail };
  }

  /** Bounds in the frame of the first part: left, low, right, high; null if not known. */
  bounds(): readonly [number, number, number, number] | null {
    return null;
  }

  /** A short summary: "340 points". */
  protected detail(): string {
    return "";
  }

  protected isEmpty(): boolean {
    return this.parts().every(({ primitives }) => primitives.length === 0);
  }

  /** Act after a while; calls before it act once. */
  protected later(delayMs: number, act: () => void): void {
    this.#timer ??= setTimeout(() => {
      this.#timer = undefined;
      act();
    }, delayMs);
  }

  protected abstract build(): Part[];

  /** Note a message; keep the newest by default. */
  protected take(value: T, _message: Message<T>): void {
    this.message = value;
  }

  protected get colour(): string {
    return this.look.colour ?? this.around.theme.colour(this.traits.colour ?? "ink");
  }

  protected get size(): number {
    return this.look.size ?? this.traits.size?.value ?? 1;
  }

  protected get choice(): string {
    return this.look.choice ?? this.traits.choices?.values[0] ?? "";
  }

  #take(message: Message<T>): void {
    if (message.type !== this.#expected) return;
    if (this.look.decayS > 0) this.#keep();
    this.receivedMs = performance.now();
    this.take(message.value, message);
    this.restyle();
  }

  /** Keep what is drawn now for a while, where it is now. */
  #keep(): void {
    const { transforms, fixedFrame } = this.around;
    if (fixedFrame === null || this.#parts === null) return;
    const parts = this.#parts.flatMap((part) => {
      const frozen: Transform | null = transforms.lookUp(fixedFrame, part.frame);
      return frozen === null ? [] : [{ ...part, frozen }];
    });
    this.#kept.push({ parts, untilMs: performance.now() + 1000 * this.look.decayS, numbers: numbersOf(parts) });
    let numbers = this.#kept.reduce((sum, kept) => sum + kept.numbers, 0);
    while (this.#kept.length > MOST_KEPT || numbers > MOST_KEPT_NUMBERS) numbers -= this.#kept.shift()!.numbers;
  }
}

function numbersOf(parts: readonly Part[]): number {
  const sizes = parts.flatMap(({ primitives }) => primitives.map((each) => ("positions" in each ? each.positions.length : 0)));
  return sizes.reduce((sum, size) => sum + size, 0);
}
