/** A display: a topic, or what the page computes, as primitives; with settings and a status. */

import type { Connection, Dispose, Message } from "../connection/connection";
import type { Theme } from "../theme/theme";
import type { TransformTree } from "../transforms/transform_tree";
import { placeOf, type Part } from "./primitives";
import type { Box } from "./viewing";

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
  readonly level: "ok" | "empty" | "late" | "error" | "off";
  readonly text: string;
}

/** A status with what is missing from an otherwise drawn message. */
export function withProblem(status: DisplayStatus, problem: string): DisplayStatus {
  if (problem === "" || (status.level !== "ok" && status.level !== "empty")) return status;
  return { level: "late", text: status.text ? `${status.text}, ${problem}` : problem };
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
  #built: readonly Part[] | null = null;
  /** What is built, where it is drawn. */
  #parts: readonly Part[] | null = null;
  /** Why the newest message is refused or could not be drawn; empty if it is drawn. */
  #problem = "";
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
      this.#end = this.around.connection.subscribe<T>(topic, { rateHz, every }, (message) => {
        if (message.type === this.#expected) this.attempt(() => this.#accept(message));
      });
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
    this.#problem = "";
    this.restyle();
  }

  /** Colours, sizes or data changed: make the primitives again when they are drawn. */
  restyle(): void {
    this.#built = null;
    this.replace();
  }

  /** The place changed: primitives remain as they are. */
  protected replace(): void {
    this.#parts = null;
    this.around.invalidate();
  }

  /** Primitives of the newest message. */
  parts(): readonly Part[] {
    if (this.#parts === null) this.attempt(() => this.#make());
    return this.#parts ?? [];
  }

  /** Draw nothing until there is something new: an error of one display must not stop the others. */
  readonly fail = (error: unknown): void => {
    reportError(error);
    this.dropParts();
    this.#problem = `cannot be drawn: ${error instanceof Error ? error.message : String(error)}`;
    this.around.invalidate();
  };

  status(): DisplayStatus {
    const { connection, transforms, fixedFrame } = this.around;
    if (!this.isVisible) return { level: "off", text: "hidden" };
    if (this.topic !== null) {
      const known = connection.topics.get(this.topic);
      if (!known?.isPublished) return { level: "empty", text: `no node publishes ${this.topic}` };
      if (known.type !== this.#expected) return { level: "error", text: `wrong type: ${known.type}` };
      if (this.receivedMs === null && this.#problem === "") return { level: "empty", text: "no messages yet" };
    }
    const part = this.parts()[0];
    if (this.#problem !== "") return { level: "error", text: this.#problem };
    if (part && fixedFrame !== null && placeOf(part, fixedFrame, transforms) === null) {
      return { level: "error", text: `no transform from ${part.frame || "a frame without a name"} to ${fixedFrame}` };
    }
    const detail = this.detail();
    return this.isEmpty() ? { level: "empty", text: detail || "the message is empty" } : { level: "ok", text: detail };
  }

  /** Bounds in the frame of the first part: left, low, right, high; null if not known. */
  bounds(): Box | null {
    let box: Box | null = null;
    if (this.#problem === "") this.attempt(() => (box = this.extent()));
    return box;
  }

  protected extent(): Box | null {
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

  /** Parts where they are drawn: at the newest transforms of their frames by default. */
  protected placed(parts: readonly Part[]): readonly Part[] {
    return parts;
  }

  /** Note a message; keep the newest by default. */
  protected take(value: T, _message: Message<T>): void {
    this.message = value;
  }

  /** Why a message cannot be drawn, which is refused then; empty if it can. */
  protected problemOf(_value: T): string {
    return "";
  }

  protected attempt(act: () => void): void {
    try {
      act();
    } catch (error) {
      this.fail(error);
    }
  }

  protected dropParts(): void {
    this.#built = this.#parts = [];
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

  /** A message that is drawn from now on. */
  protected receive(message: Message<T>): void {
    this.receivedMs = performance.now();
    this.#problem = "";
    this.take(message.value, message);
    this.restyle();
  }

  #accept(message: Message<T>): void {
    const problem = this.problemOf(message.value);
    if (problem === "") return this.receive(message);
    this.clear();
    this.#problem = problem;
  }

  #make(): void {
    this.#built ??= this.build();
    this.#parts = this.placed(this.#built);
    if (this.#parts.length > 0) this.#problem = "";
  }
}
