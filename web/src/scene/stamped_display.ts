/** A display of messages with a header: each is drawn where its frame was at its stamp. */

import type { Dispose, Message } from "../connection/connection";
import { nanosecondsOf } from "../transforms/stamp";
import { nextFrame } from "../ui/frames";
import { Display, type DisplayStatus } from "./display";
import type { Header } from "./messages";
import { Placement } from "./placement";
import type { Part } from "./primitives";

/** How long a message waits for the transforms of its stamp, in the robot's time. */
const WAIT_NS = 1_000_000_000n;
/** Of more, the oldest is drawn by the nearest transforms that are known. */
const MOST_WAITING = 30;
/** Messages that remain by decay: at most so many, with so many coordinates in all. */
const MOST_KEPT = 600;
const MOST_KEPT_NUMBERS = 3_000_000;

interface Waiting {
  readonly placement: Placement;
  readonly sinceNs: bigint;
  /** Whether it replaces all before it. */
  readonly isWhole: boolean;
  show(): void;
}

export abstract class StampedDisplay<T extends { header: Header }> extends Display<T> {
  #placement: Placement | null = null;
  /** Of stamps newer than the transforms, oldest first. */
  #waiting: Waiting[] = [];
  #kept: { parts: readonly Part[]; untilMs: number; numbers: number }[] = [];
  #endWait: Dispose | null = null;

  override clear(): void {
    this.#placement = null;
    this.#waiting = [];
    this.#kept = [];
    this.#stopWaiting();
    super.clear();
  }

  /** Primitives of now, and those that remain. */
  override parts(): readonly Part[] {
    const present = super.parts();
    if (this.#kept.length === 0) return present;
    const now = performance.now();
    this.#kept = this.#kept.filter(({ untilMs }) => untilMs > now);
    if (this.#kept.length > 0) this.later(100, () => this.around.invalidate());
    return [...this.#kept.flatMap(({ parts }) => parts), ...present];
  }

  override status(): DisplayStatus {
    const status = super.status();
    const [frame, lagNs] = [this.#placement?.frame ?? "", this.#placement?.lagNs ?? 0n];
    if (status.level === "ok" && lagNs > 0n) {
      return { level: "late", text: `the newest transform of ${frame} is ${(Number(lagNs) / 1e9).toFixed(1)} s older than the message` };
    }
    const isFirst = this.receivedMs === null && this.#waiting.length > 0;
    return isFirst ? { level: "empty", text: `waiting for a transform of ${this.#waiting[0]!.placement.frame}` } : status;
  }

  /** Wait until the transforms reach the stamp of the message, if they soon will. */
  protected override receive(message: Message<T>): void {
    const placement = this.placementOf(this.headerOf(message.value));
    this.whenPlaced(placement, true, () => {
      if (this.look.decayS > 0) this.#keep();
      this.#placement = placement;
      super.receive(message);
    });
  }

  /** Show a message, or a change of it, once the transforms reach its stamp. */
  protected whenPlaced(placement: Placement, isWhole: boolean, show: () => void): void {
    this.#waiting.push({ placement, isWhole, show, sinceNs: this.#nowNs() });
    this.#release();
  }

  protected placementOf({ frame_id: frame, stamp }: Header): Placement {
    return new Placement(this.around.transforms, frame, nanosecondsOf(stamp));
  }

  /** The message was changed: it is of another stamp now. */
  protected moveTo(placement: Placement): void {
    this.#placement = placement;
    this.replace();
  }

  protected override placed(parts: readonly Part[]): readonly Part[] {
    const placement = this.#placement;
    return placement ? parts.map((part) => ({ ...part, placement })) : parts;
  }

  protected headerOf({ header }: T): Header {
    return header;
  }

  protected override dropParts(): void {
    this.#kept = [];
    super.dropParts();
  }

  /** Show the newest message that waits no longer, and changes; messages before it are outdated. */
  #release(): void {
    const nowNs = this.#nowNs();
    const isReady = ({ placement: { lagNs }, sinceNs }: Waiting): boolean => lagNs === 0n || lagNs > WAIT_NS || nowNs - sinceNs > WAIT_NS;
    const index = Math.max(this.#waiting.findLastIndex(isReady), this.#waiting.length - 1 - MOST_WAITING);
    const ready = this.#waiting.splice(0, index + 1);
    if (this.#waiting.length > 0) this.#startWaiting();
    else this.#stopWaiting();
    const newest = ready.findLast(({ isWhole }) => isWhole);
    for (const each of ready) if (each === newest || !each.isWhole) this.attempt(() => each.show());
  }

  readonly #releaseAgain = (): void => this.#release();

  #startWaiting(): void {
    if (this.#endWait) return;
    const { transforms, connection } = this.around;
    const ends = [transforms.onTransform(() => nextFrame(this.#releaseAgain)), connection.on("time", this.#releaseAgain)];
    // A server that sends no time.
    const timer = setInterval(this.#releaseAgain, 1000);
    this.#endWait = () => {
      clearInterval(timer);
      ends.forEach((end) => end());
    };
  }

  #stopWaiting(): void {
    this.#endWait?.();
    this.#endWait = null;
  }

  /** The robot's time, which stands still while it is paused; the page's where the server has none. */
  #nowNs(): bigint {
    return this.around.connection.nowNs || BigInt(Math.round(performance.now() * 1e6));
  }

  /** Keep what is drawn now for a while. */
  #keep(): void {
    const parts = super.parts();
    this.#kept.push({ parts, untilMs: performance.now() + 1000 * this.look.decayS, numbers: numbersOf(parts) });
    let numbers = this.#kept.reduce((sum, kept) => sum + kept.numbers, 0);
    while (this.#kept.length > MOST_KEPT || numbers > MOST_KEPT_NUMBERS) numbers -= this.#kept.shift()!.numbers;
  }
}

function numbersOf(parts: readonly Part[]): number {
  const sizes = parts.flatMap(({ primitives }) => primitives.map((each) => ("positions" in each ? each.positions.length : 0)));
  return sizes.reduce((sum, size) => sum + size, 0);
}
