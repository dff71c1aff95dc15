/** A recording that the server plays: its range, state and control. */

import type { PlaybackState } from "./connection";
import { playbackControl, type PlaybackFrame } from "./server_socket";

const STATUS = ["playing", "paused", "buffering", "ended"] as const;

interface RecordingInfo {
  readonly capabilities: readonly string[];
  readonly dataStartTime?: { sec: number; nsec: number };
  readonly dataEndTime?: { sec: number; nsec: number };
}

export class PlaybackControl {
  state: PlaybackState | null = null;
  #requests = 0;
  readonly #page = `page-${Math.random().toString(36).slice(2)}-`;

  constructor(private readonly send: (frame: string | ArrayBuffer) => void) {}

  begin({ capabilities, dataStartTime, dataEndTime }: RecordingInfo): void {
    this.state = null;
    if (!capabilities.includes("playbackControl") || !dataStartTime || !dataEndTime) return;
    this.state = { status: "paused", beginNs: nsOf(dataStartTime), endNs: nsOf(dataEndTime), speed: 1 };
  }

  end(): void {
    this.state = null;
  }

  take({ status, speed }: PlaybackFrame): void {
    if (this.state) this.state = { ...this.state, status: STATUS[status] ?? "paused", speed };
  }

  control({ play, seekNs, speed, step }: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void {
    if (!this.state) return;
    if (step) {
      this.send('{"op":"stepPlayback"}');
      return;
    }
    const id = `${this.#page}${(this.#requests += 1)}`;
    this.send(playbackControl(play ?? this.state.status === "playing", speed ?? this.state.speed, seekNs ?? null, id));
  }
}

function nsOf({ sec, nsec }: { sec: number; nsec: number }): bigint {
  return BigInt(sec) * 1_000_000_000n + BigInt(nsec);
}
