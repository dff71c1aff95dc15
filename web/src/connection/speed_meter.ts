/** The robot's time, and how fast it passes. */

const WINDOW_MS = 3000;
/** Time that goes back by less is a late frame. */
const BACK_NS = 50_000_000n;
const TOGETHER_MS = 10;

export class SpeedMeter {
  nowNs = 0n;
  #samples: { ns: bigint; ms: number; sinceMs: number }[] = [];

  /** Take the time at a wall time; true if time went back. */
  take(ns: bigint, ms: number): boolean {
    const isBack = ns + BACK_NS < this.nowNs;
    if (isBack) this.#samples = [];
    this.nowNs = ns;
    // Samples that waited behind a slow frame arrive together: the newest of them waited least.
    const last = this.#samples.at(-1);
    const isTogether = last !== undefined && ms - last.sinceMs < TOGETHER_MS;
    if (isTogether) this.#samples.pop();
    this.#samples.push({ ns, ms, sinceMs: isTogether ? last.sinceMs : ms });
    while (this.#samples.length > 2 && ms - this.#samples[1]!.ms > WINDOW_MS) this.#samples.shift();
    return isBack;
  }

  /** Robot time per wall time; null until it is known. */
  get speed(): number | null {
    const [first, last] = [this.#samples[0], this.#samples.at(-1)];
    if (!first || !last || last.ms - first.ms < 500) return null;
    return Number(last.ns - first.ns) / 1e6 / (last.ms - first.ms);
  }

  clear(): void {
    this.nowNs = 0n;
    this.#samples = [];
  }
}
