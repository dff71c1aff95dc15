/** The bar under a recording that is played: play, step, seek, rate. */

import "./playback.css";
import type { Dispose } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { clockText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

const STEPS = 10_000;
const SEEK_MS = 80;
const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const TEXTS = { playing: "Playing", paused: "Paused", buffering: "Loading", ended: "Ended" } as const;

class PlaybackPanel implements PanelInstance {
  readonly #play = h("button", { class: "main playback-play", onclick: () => this.#control({ play: this.context.connection.playback?.status !== "playing" }) });
  readonly #step = h("button", { class: "bare", title: "Next message", "aria-label": "Next message", onclick: () => this.#control({ step: true }) }, icon("step"));
  readonly #slider = h("input", { type: "range", min: 0, max: STEPS, value: 0, class: "playback-slider", "aria-label": "Position", oninput: () => this.#seekSoon() });
  readonly #text = h("output", { class: "number playback-text" });
  readonly #rate = h("select", { "aria-label": "Rate", onchange: () => this.#control({ speed: Number(this.#rate.value) }) });
  readonly #status = h("span", { class: "hint playback-status" });
  readonly #bar: HTMLElement;
  readonly #empty = emptyState("playback", "No recording", "navette bag play FILE --view opens a recording here.");
  readonly #ends: Dispose[] = [];
  #timer: ReturnType<typeof setTimeout> | undefined;
  #heldUntilMs = 0;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    this.#bar = h("div", { class: "playback-bar", role: "group", "aria-label": "Playback" }, this.#play, this.#step, this.#slider, this.#text, this.#rate, this.#status);
    container.append(h("div", { class: "panel" }, h("div", { class: "body playback-body" }, this.#bar, this.#empty.element)));
    this.#show();
  }

  setVisible(isVisible: boolean): void {
    for (const end of this.#ends.splice(0)) end();
    if (!isVisible) return;
    this.#ends.push(this.context.connection.on("playback", () => this.#show()), every(10, () => this.#showPosition()));
    this.#show();
  }

  dispose = (): void => {
    this.setVisible(false);
    clearTimeout(this.#timer);
  };

  #control(request: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void {
    this.context.connection.controlPlayback(request);
  }

  #show(): void {
    const state = this.context.connection.playback;
    this.#bar.hidden = state === null;
    this.#empty.element.hidden = state !== null;
    if (!state) return;
    const isPlaying = state.status === "playing";
    if (this.#play.dataset["playing"] !== String(isPlaying)) {
      this.#play.dataset["playing"] = String(isPlaying);
      this.#play.replaceChildren(icon(isPlaying ? "pause" : "play"));
      this.#play.title = isPlaying ? "Pause" : "Play";
      this.#play.setAttribute("aria-label", this.#play.title);
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
    const { playback, nowNs } = this.context.connection;
    // What the hand holds, and what the server has not reached yet, stays.
    if (!playback || this.#timer !== undefined || performance.now() < this.#heldUntilMs) return;
    const length = Number(playback.endNs - playback.beginNs);
    const share = length > 0 ? Math.min(1, Math.max(0, Number(nowNs - playback.beginNs) / length)) : 1;
    this.#slider.value = String(Math.round(share * STEPS));
    this.#write();
  }

  #write(): void {
    const { playback } = this.context.connection;
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
      const { playback } = this.context.connection;
      if (!playback) return;
      const share = BigInt(this.#slider.value);
      this.#heldUntilMs = performance.now() + 400;
      this.#control({ seekNs: playback.beginNs + ((playback.endNs - playback.beginNs) * share) / BigInt(STEPS) });
    }, SEEK_MS);
  }
}

registerPanel({
  id: "playback",
  title: "Playback",
  icon: "playback",
  place: "below",
  hint: "Play, pause, seek and step a recording.",
  create: (container, context) => new PlaybackPanel(container, context),
});
