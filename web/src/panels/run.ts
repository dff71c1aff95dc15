/** Run control of a simulation: pause, step, reset, speed. */

import "./run.css";
import type { Dispose } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { clockText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";
import { findRun, RunServices, type RunState } from "./run_services";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 3, 5, 10];
const STEPS = [1, 10, 100];
const POLL_HZ = 1;

class RunPanel implements PanelInstance {
  readonly #controls: HTMLElement;
  readonly #play = h("button", { class: "main run-play", onclick: () => void this.#do((run) => run.setPaused(this.#state?.isPaused !== true)) });
  readonly #step = h("button", { title: "Advance by one step", onclick: () => void this.#do((run) => run.step(Number(this.#steps.value))) }, icon("step"), "Step");
  readonly #steps = h("select", { "aria-label": "Length of a step" });
  readonly #reset = h("button", { title: "Put robot and world back to the start", onclick: () => void this.#do((run) => run.reset()) }, icon("reset"), "Reset");
  readonly #speed = h("select", { "aria-label": "Speed, as a multiple of real time", onchange: () => void this.#do((run) => run.setRate(Number(this.#speed.value))) });
  readonly #time = h("output", { class: "run-time number" });
  readonly #measured = h("span", { class: "hint number" });
  readonly #result = h("p", { class: "hint bad", role: "alert", hidden: true });
  readonly #empty = emptyState("run", "Nothing to control", "A simulation that is served here can be paused, stepped and reset.");
  readonly #ends: Dispose[] = [];
  #state: RunState | null = null;
  #run: RunServices | null = null;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    this.#steps.append(...STEPS.map((steps) => new Option(`${steps * 10} ms`, String(steps))));
    this.#steps.value = "10";
    this.#controls = h("div", { class: "run-controls" },
      h("div", { class: "row" }, this.#time, this.#measured),
      h("div", { class: "row" }, this.#play, h("span", { class: "run-pair" }, this.#step, this.#steps), this.#reset),
      h("label", { class: "run-speed" }, "Speed", this.#speed),
      this.#result);
    container.append(h("div", { class: "panel" }, h("div", { class: "body" }, this.#controls, this.#empty.element)));
    this.#show();
  }

  setVisible(isVisible: boolean): void {
    for (const end of this.#ends.splice(0)) end();
    if (!isVisible) return;
    const { connection } = this.context;
    this.#ends.push(
      connection.on("services", () => this.#find()),
      connection.on("status", () => this.#find()),
      every(POLL_HZ, () => void this.#poll()),
      every(5, () => this.#showTime()),
    );
    this.#find();
  }

  dispose = (): void => {
    this.setVisible(false);
  };

  #find(): void {
    const prefix = findRun(this.context.connection.services);
    if (prefix === (this.#run?.prefix ?? null)) return;
    this.#run = prefix === null ? null : new RunServices(this.context.connection, prefix);
    this.#state = null;
    this.#show();
    void this.#poll();
  }

  async #poll(): Promise<void> {
    const run = this.#run;
    if (!run) return;
    const state = await run.read().catch(() => null);
    if (run !== this.#run || !state) return;
    this.#state = state;
    this.#show();
  }

  async #do(action: (run: RunServices) => Promise<void>): Promise<void> {
    if (!this.#run) return;
    this.#result.hidden = true;
    try {
      await action(this.#run);
    } catch (error) {
      setText(this.#result, error instanceof Error ? error.message : String(error));
      this.#result.hidden = false;
    }
    await this.#poll();
  }

  #show(): void {
    this.#controls.hidden = this.#run === null;
    this.#empty.element.hidden = this.#run !== null;
    if (this.context.connection.playback) this.#empty.set("A recording is played", "The playback bar controls it.");
    else this.#empty.set("Nothing to control", "A simulation that is served here can be paused, stepped and reset.");
    const isPaused = this.#state?.isPaused === true;
    if (this.#play.dataset["paused"] !== String(isPaused)) {
      this.#play.dataset["paused"] = String(isPaused);
      this.#play.replaceChildren(icon(isPaused ? "play" : "pause"), isPaused ? "Continue" : "Pause");
    }
    this.#step.disabled = !isPaused;
    this.#steps.disabled = !isPaused;
    this.#showSpeed();
    this.#showTime();
  }

  #showSpeed(): void {
    const rate = this.#state?.rate ?? null;
    this.#speed.disabled = rate === null || !Number.isFinite(rate);
    if (document.activeElement === this.#speed || rate === null) return;
    const speeds = !Number.isFinite(rate) || SPEEDS.includes(rate) ? SPEEDS : [...SPEEDS, rate].sort((a, b) => a - b);
    const options = speeds.map((speed) => new Option(`${speed} × real time`, String(speed)));
    if (!Number.isFinite(rate)) options.push(new Option("as fast as possible", String(rate)));
    this.#speed.replaceChildren(...options);
    this.#speed.value = String(rate);
  }

  #showTime(): void {
    const { connection } = this.context;
    setText(this.#time, clockText(Number(connection.nowNs) / 1e9));
    const speed = connection.speed;
    setText(this.#measured, this.#state?.isPaused ? "paused" : speed === null ? "" : `${speed.toFixed(2)} × real time`);
  }
}

registerPanel({
  id: "run",
  title: "Run control",
  icon: "run",
  place: "right",
  hint: "Pause, step, reset a simulation and change its speed.",
  create: (container, context) => new RunPanel(container, context),
});
