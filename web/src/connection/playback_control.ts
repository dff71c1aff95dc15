/** A recording that the server plays: its range, state and control. */

import type { PlaybackState } from "./connection";
import { playbackControl, type PlaybackFrame } from "./server_socket";

const STATUS = ["playing", "paused", "buffering", "ended"] as const;

interface RecordingInfo {
  readonly capabilities: readonly string[];
  readonly dataStartTime?: { sec: number; nsec: number };
  readonly dataEndTime?: { sec: number; nsec: number };
}

/** What the page requested last; the server has not reported it yet. */
interface Requested {
  readonly id: string;
  readonly play: boolean;
  readonly speed: number;
}

export class PlaybackControl {
  state: PlaybackState | null = null;
  #requested: Requested | null = null;
  #requests = 0;
  readonly #page = `page-${Math.random().toString(36).slice(2)}-`;

  constructor(private readonly send: (frame: string | ArrayBuffer) => void) {}

  begin({ capabilities, dataStartTime, dataEndTime }: RecordingInfo): void {
    this.end();
    if (!capabilities.includes("playbackControl") || !dataStartTime || !dataEndTime) return;
    this.state = { status: "paused", beginNs: nsOf(dataStartTime), endNs: nsOf(dataEndTime), speed: 1 };
  }

  end(): void {
    this.state = null;
    this.#requested = null;
  }

  take({ status, speed, requestId }: PlaybackFrame): void {
    if (requestId === this.#requested?.id) this.#requested = null;
    if (this.state) this.state = { ...this.state, status: STATUS[status] ?? "paused", speed };
  }

  control({ play, seekNs, speed, step }: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void {
    if (!this.state) return;
    // A seek right after Pause must not play on.
    const last = this.#requested ?? { play: this.state.status === "playing", speed: this.state.speed };
    if (step) {
      this.#requested = { ...last, id: "", play: false };
      this.send('{"op":"stepPlayback"}');
      return;
    }
    const id = `${this.#page}${(this.#requests += 1)}`;
    this.#requested = { id, play: play ?? last.play, speed: speed ?? last.speed };
    this.send(playbackControl(this.#requested.play, this.#requested.speed, seekNs ?? null, id));
  }
}

function nsOf({ sec, nsec }: { sec: number; nsec: number }): bigint {
  return BigInt(sec) * 1_000_000_000n + BigInt(nsec);
}
