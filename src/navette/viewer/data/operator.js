// The operator at this page: arrow keys drive, Space stops, buttons stop, release, cancel.
"use strict";

const KEYS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };
const SPEED_MPS = 0.5, TURN_RADPS = 0.8, PERIOD_MS = 100;
const STOP_REPEATS = 20; // every PERIOD_MS, until the arbiter confirms the stop

const operator = {
  held: new Set(),
  timer: null,

  /** drive(m/s, rad/s), stop(), release(), cancel() publish; isStopped() is confirmed. */
  start(parts, { drive, stop, release, cancel, isStopped, mayDrive }) {
    Object.assign(this, { parts, drive, publishStop: stop, isStopped, mayDrive });
    parts.stop.onclick = () => this.stop();
    parts.release.onclick = () => { clearInterval(this.stopping); release(); };
    parts.cancel.onclick = () => cancel();
    addEventListener("keydown", (event) => this.onKey(event));
    addEventListener("keyup", (event) => {
      if (this.held.delete(event.key) && !this.held.size) this.beat();
      if (event.key === " " && this.takes(event)) event.preventDefault(); // presses no button
    });
    // Without the focus a released key is not reported.
    for (const lost of ["blur", "pagehide"]) addEventListener(lost, () => this.letGo());
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.letGo(); });
    document.addEventListener("focusin", (event) => { if (isText(event.target)) this.letGo(); });
  },
  takes(event) {
    return !(isText(event.target) || event.ctrlKey || event.metaKey || event.altKey) && this.mayDrive();
  },
  onKey(event) {
    if (!this.takes(event)) return;
    if (event.key === " ") { event.preventDefault(); if (!event.repeat) this.stop(); }
    if (!(event.key in KEYS)) return;
    event.preventDefault();
    if (event.repeat || this.held.has(event.key)) return;
    this.held.add(event.key);
    this.beat(); // a change of direction is sent at once
    this.timer ??= setInterval(() => this.beat(), PERIOD_MS);
  },
  beat() {
    const sum = [...this.held].reduce(([v, w], key) => [v + KEYS[key][0], w + KEYS[key][1]], [0, 0]);
    this.drive(sum[0] * SPEED_MPS, sum[1] * TURN_RADPS);
    if (this.held.size === 0) { clearInterval(this.timer); this.timer = null; }
  },
  letGo() { if (this.held.size) { this.held.clear(); this.beat(); } },
  stop() {
    this.letGo();
    clearInterval(this.stopping);
    let left = STOP_REPEATS;
    const request = () => { if (left-- && !this.isStopped()) this.publishStop(); else clearInterval(this.stopping); };
    this.publishStop();
    this.stopping = setInterval(request, PERIOD_MS);
  },

  /** Show who commands; `arbiter` is its status, undefined without one. */
  draw(arbiter) {
    const stopped = arbiter?.message === "emergency_stop";
    document.body.classList.toggle("stopped", stopped);
    this.parts.release.hidden = !stopped;
    this.parts.stop.textContent = stopped ? "Stopped" : "Stop";
    return arbiter ? commanderText(arbiter) : "–";
  },
};

const isText = (element) => Boolean(element.closest?.("input, select, textarea, [contenteditable]"));
/** "Operator (viewer)", "Navigation", "Emergency stop". */
function commanderText({ message, values }) {
  const name = message.replaceAll("_", " "), from = values.nodes?.replaceAll("/", "").replaceAll(",", ", ");
  const who = message !== "navigation" && from ? ` (${from})` : "";
  return name.charAt(0).toUpperCase() + name.slice(1) + who;
}
