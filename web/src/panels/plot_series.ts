/** Samples of one plotted number: bounded memory, oldest dropped. */

const MOST_SAMPLES = 20_000;

export class PlotSeries {
  #times = new Float64Array(256);
  #values = new Float64Array(256);
  #begin = 0;
  #end = 0;

  get length(): number {
    return this.#end - this.#begin;
  }

  get firstTime(): number | null {
    return this.length > 0 ? this.#times[this.#begin]! : null;
  }

  get lastTime(): number | null {
    return this.length > 0 ? this.#times[this.#end - 1]! : null;
  }

  get lastValue(): number | null {
    return this.length > 0 ? this.#values[this.#end - 1]! : null;
  }

  /** Add a sample; time that goes back begins anew. */
  add(timeS: number, value: number): void {
    if (this.lastTime !== null && timeS < this.lastTime) this.clear();
    if (this.#end === this.#times.length) this.#makeRoom();
    this.#times[this.#end] = timeS;
    this.#values[this.#end] = value;
    this.#end += 1;
  }

  clear(): void {
    this.#begin = this.#end = 0;
  }

  /** Samples from a time on. */
  since(timeS: number): [times: Float64Array, values: Float64Array] {
    let low = this.#begin;
    let high = this.#end;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.#times[middle]! < timeS) low = middle + 1;
      else high = middle;
    }
    return [this.#times.subarray(low, this.#end), this.#values.subarray(low, this.#end)];
  }

  #makeRoom(): void {
    const keep = Math.min(this.length, MOST_SAMPLES);
    const from = this.#end - keep;
    const size = Math.min(2 * Math.max(keep, 128), 2 * MOST_SAMPLES);
    const [times, values] = [new Float64Array(size), new Float64Array(size)];
    times.set(this.#times.subarray(from, this.#end));
    values.set(this.#values.subarray(from, this.#end));
    [this.#times, this.#values, this.#begin, this.#end] = [times, values, 0, keep];
  }
}

/** All samples of several series as CSV, one row per time. */
export function csvOf(names: readonly string[], series: readonly PlotSeries[]): string {
  const rows = new Map<number, (number | undefined)[]>();
  series.forEach((each, column) => {
    const [times, values] = each.since(-Infinity);
    times.forEach((time, index) => {
      let row = rows.get(time);
      if (!row) rows.set(time, (row = []));
      row[column] = values[index]!;
    });
  });
  const quoted = names.map((name) => `"${name.replaceAll('"', '""')}"`);
  const lines = [...rows].sort(([a], [b]) => a - b).map(([time, row]) => [time.toFixed(6), ...names.map((_, column) => row[column] ?? "")].join(","));
  return `${["time_s", ...quoted].join(",")}\n${lines.join("\n")}\n`;
}
