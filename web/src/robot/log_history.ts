/** Log lines of all nodes since the page opened: few and small, so they are kept for panels to come. */

import type { Connection, Dispose } from "../connection/connection";
import { nanosecondsOf, type Stamp } from "../transforms/stamp";

interface LogMessage {
  stamp: Stamp;
  level: number;
  name: string;
  msg: string;
  file: string;
  function: string;
  line: number;
}

export interface LogEntry {
  readonly stampNs: bigint;
  readonly level: number;
  readonly node: string;
  readonly text: string;
  /** File, line and function, or empty. */
  readonly place: string;
}

const MOST_KEPT = 5000;
const DROPPED_AT_ONCE = 500;

export class LogHistory {
  #entries: LogEntry[] = [];
  #total = 0;
  readonly #listeners = new Set<() => void>();

  constructor(connection: Connection) {
    connection.subscribe<LogMessage>("/rosout", { every: true }, ({ value }) => this.#add(value));
    connection.on("reset", () => connection.playback && this.clear());
  }

  /** The newest lines, oldest first. */
  get entries(): readonly LogEntry[] {
    return this.#entries;
  }

  /** Number of lines so far, with those that are dropped. */
  get total(): number {
    return this.#total;
  }

  clear(): void {
    this.#entries = [];
    this.#changed();
  }

  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  #add({ stamp, level, name, msg, file, function: where, line }: LogMessage): void {
    this.#entries.push({ stampNs: nanosecondsOf(stamp), level, node: name, text: msg, place: file ? `${file}:${line} ${where}` : "" });
    this.#total += 1;
    if (this.#entries.length > MOST_KEPT + DROPPED_AT_ONCE) this.#entries.splice(0, DROPPED_AT_ONCE);
    this.#changed();
  }

  #changed(): void {
    for (const callback of this.#listeners) callback();
  }
}
