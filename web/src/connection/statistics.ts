/** Rate and bandwidth of a stream of messages, in the robot's time. */

import type { Statistics } from "./connection";

const WINDOW_NS = 5_000_000_000n;
const MOST = 512;

export class Meter {
  #stamps: bigint[] = [];
  #sizes: number[] = [];
  #bytes = 0;
  #count = 0;

  add(stampNs: bigint, bytes: number): void {
    const last = this.#stamps.at(-1);
    if (last !== undefined && stampNs < last) this.reset();
    this.#stamps.push(stampNs);
    this.#sizes.push(bytes);
    this.#bytes += bytes;
    this.#count += 1;
    const oldest = stampNs - WINDOW_NS;
    let drop = Math.max(0, this.#stamps.length - MOST);
    while (drop < this.#stamps.length - 2 && this.#stamps[drop]! < oldest) drop += 1;
    // In batches: moving an array by one for each message would cost its length.
    if (drop > 64 || this.#stamps.length > 2 * MOST || (drop > 0 && this.#stamps.length < 64)) {
      for (let index = 0; index < drop; index += 1) this.#bytes -= this.#sizes[index]!;
      this.#stamps.splice(0, drop);
      this.#sizes.splice(0, drop);
    }
  }

  reset(): void {
    this.#stamps = [];
    this.#sizes = [];
    this.#bytes = 0;
  }

  /** A topic that stopped counts down: the time until now is part of the span. */
  read(nowNs: bigint): Statistics {
    const [first, last] = [this.#stamps[0], this.#stamps.at(-1)];
    const n = this.#stamps.length;
    if (first === undefined || last === undefined) return { rateHz: null, bytesPerS: 0, count: this.#count, lastNs: 0n };
    const periodNs = n > 1 ? Number(last - first) / (n - 1) : 0;
    const silentNs = Number(nowNs - last);
    const isLate = silentNs > Math.max(2 * periodNs, 1e9);
    if (isLate && silentNs > Number(WINDOW_NS) + 2 * periodNs) return { rateHz: n > 1 ? 0 : null, bytesPerS: 0, count: this.#count, lastNs: last };
    const spanS = (Number(last - first) + (isLate ? silentNs : periodNs)) / 1e9;
    const known = n > 1 && spanS > 0;
    return { rateHz: known ? n / spanS : null, bytesPerS: known ? this.#bytes / spanS : 0, count: this.#count, lastNs: last };
  }
}
