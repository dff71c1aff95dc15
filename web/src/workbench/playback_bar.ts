/** The bar below the scene while a recording is played: play, step, seek, rate. */

import "./playback_bar.css";
import type { Connection } from "../connection/connection";
import { clockText } from "../panels/format";
import { takesSpace } from "../tools/teleop";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";

const STEPS = 10_000;
const SEEK_MS = 80;
const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const TEXTS = { playing: "Playing", paused: "Paused", buffering: "Loading", ended: "Ended" } as const;

export class PlaybackBar {
  readonly element: HTMLElement;
  readonly #play = h("button", { class: "main playback-play", onclick: () => this.#toggle() });
  readonly #step = h("button", { class: "bare", title: "Next message", "aria-label": "Next message", onclick: () => this.#control({ step: true }) }, icon("step"));
  readonly #slider = h("input", { type: "range", min: 0, max: STEPS, value: 0, class: "playback-slider", "aria-label": "Position", oninput: () => this.#seekSoon() });
  readonly #text = h("output", { class: "number playback-text" });
  readonly #rate = h("select", { "aria-label": "Rate", onchange: () => this.#control({ speed: Number(this.#rate.value) }) });
  readonly #status = h("span", { class: "hint playback-status" });
  #timer: ReturnType<typeof setTimeout> | undefined;
  #heldUntilMs = 0;

  constructor(private readonly connection: Connection) {
    this.element = h("section", { class: "playback-bar", "aria-label": "Playback" }, this.#play, this.#step, this.#slider, this.#text, this.#rate, this.#status);
    connection.on("playback", () => this.#show());
    connection.on("status", () => this.#show());
    every(10, () => this.#showPosition());
    for (const type of ["keydown", "keyup"] as const) addEventListener(type, (event) => this.#onKey(event));
    this.#show();
  }

  /** Space plays and pauses; a robot that drives takes it for Stop before. */
  #onKey(event: KeyboardEvent): void {
    const isTaken = event.defaultPrevented || takesSpace(event.target) || event.ctrlKey || event.metaKey || event.altKey;
    if (event.key !== " " || isTaken || this.connection.playback === null) return;
    event.preventDefault(); // presses no button
    if (event.type === "keydown" && !event.repeat) this.#toggle();
  }

  #toggle(): void {
    this.#control({ play: this.connection.playback?.status !== "playing" });
  }

  #control(request: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void {
    this.connection.controlPlayback(request);
  }

  #show(): void {
    const state = this.connection.playback;
    this.element.hidden = state === null;
    if (!state) return;
    const isPlaying = state.status === "playing";
    if (this.#play.dataset["playing"] !== String(isPlaying)) {
      this.#play.dataset["playing"] = String(isPlaying);
      this.#play.replaceChildren(icon(isPlaying ? "pause" : "play"));
      this.#play.title = `${isPlaying ? "Pause" : "Play"} (Space)`;
      this.#play.setAttribute("aria-label", isPlaying ? "Pause" : "Play");
    }
    setText(this.#status, TEXTS[state.status]);
    const rates = RATES.includes(state.speed) ? RATES : [...RATES, state.speed].sort((a, b) => a - b);
    if (this.#rate.options.length !== rates.length || this.#rate.value !== String(state.speed)) {
      this.#rate.replaceChildren(...rates.map((rate) => new Option(`${rate}×`, String(rate))));
      this.#rate.value = String(state.speed);
    }
    this.#showPosition();
  }

  #showPosition(): void {
    const { playback, nowNs } = this.connection;
    // What the hand holds, and what the server has not reached yet, stays.
    if (!playback || this.#timer !== undefined || performance.now() < this.#heldUntilMs) return;
    const length = Number(playback.endNs - playback.beginNs);
    const share = length > 0 ? Math.min(1, Math.max(0, Number(nowNs - playback.beginNs) / length)) : 1;
    this.#slider.value = String(Math.round(share * STEPS));
    this.#write();
  }

  #write(): void {
    const { playback } = this.connection;
    if (!playback) return;
    const length = Number(playback.endNs - playback.beginNs) / 1e9;
    const share = Number(this.#slider.value) / STEPS;
    this.#slider.style.setProperty("--share", `${share * 100}%`);
    const text = `${clockText(share * length, length)} / ${clockText(length, length)}`;
    setText(this.#text, text);
    this.#slider.setAttribute("aria-valuetext", text);
  }

  #seekSoon(): void {
    this.#write();
    this.#heldUntilMs = performance.now() + 400;
    this.#timer ??= setTimeout(() => {
      this.#timer = undefined;
      const { playback } = this.connection;
      if (!playback) return;
      const share = BigInt(this.#slider.value);
      this.#heldUntilMs = performance.now() + 400;
      this.#control({ seekNs: playback.beginNs + ((playback.endNs - playback.beginNs) * share) / BigInt(STEPS) });
    }, SEEK_MS);
  }
}
