// The bar under the map while a recording is played: play, step, seek, rate.
"use strict";

const PLAYING = 0, ENDED = 3, STEPS = 10000, SEEK_MS = 80;
const REQUEST = `page-${Math.random().toString(36).slice(2)}-`; // responses go to every page

const playback = {
  begin: 0n, end: 0n, status: null, speed: 1, requests: 0, answered: 0, wanted: null, timer: null,
  seeking: null, // id of the pending request: until its response the slider keeps its position

  start(bar, { sendText, sendBinary, onSeek }) {
    const part = (name) => bar.querySelector(`[name="${name}"]`);
    Object.assign(this, { bar, sendText, sendBinary, onSeek });
    this.play = part("play"); this.slider = part("place"); this.rate = part("rate");
    this.text = bar.querySelector("output");
    this.slider.max = STEPS;
    this.play.onclick = () => this.control(this.status !== PLAYING);
    part("step").onclick = () => this.sendText({ op: "stepPlayback" });
    this.rate.onchange = () => { this.speed = Number(this.rate.value); this.control(this.status === PLAYING); };
    this.slider.oninput = () => this.seekSoon();
    addEventListener("keydown", (event) => {
      if (event.key !== " " || bar.hidden || event.target.closest("input, button, select, a")) return;
      event.preventDefault();
      this.play.click();
    });
  },

  /** Show the bar if the server plays a recording. */
  greet({ capabilities, dataStartTime, dataEndTime }) {
    const ns = ({ sec, nsec }) => BigInt(sec) * 1000000000n + BigInt(nsec);
    const plays = capabilities.includes("playbackControl") && dataStartTime && dataEndTime;
    if (plays) { this.begin = ns(dataStartTime); this.end = ns(dataEndTime); }
    this.bar.hidden = !plays;
  },
  get isThere() { return !this.bar.hidden; },
  /** Status as text. */
  get description() {
    return ["Playing a recording", "Recording, paused", "Recording, loading", "Recording, ended"][this.status] ?? "A recording";
  },
  leave() { this.bar.hidden = true; this.status = this.seeking = null; },

  /** A playback state frame. */
  take(view) {
    this.status = view.getUint8(1);
    this.speed = Number(view.getFloat32(10, true).toPrecision(6));
    this.bar.dataset.status = ["playing", "paused", "buffering", "ended"][this.status] ?? "";
    const label = this.status === PLAYING ? "Pause" : "Play";
    this.play.ariaLabel = this.play.title = label;
    const id = new TextDecoder().decode(new Uint8Array(view.buffer, 19, view.getUint32(15, true)));
    if (id === this.seeking) this.seeking = null;
    if (id.startsWith(REQUEST)) this.answered = Number(id.slice(REQUEST.length));
    this.showRate();
    this.show(view.getBigUint64(2, true));
    if (view.getUint8(14)) this.onSeek();
  },
  showRate() {
    const text = String(this.speed);
    if (![...this.rate.options].some((option) => option.value === text)) {
      const others = [...this.rate.options].map((option) => Number(option.value));
      const at = others.findIndex((other) => other > this.speed);
      this.rate.add(new Option(`${text}×`, text), at < 0 ? null : at);
    }
    this.rate.value = text;
  },
  /** Show the position reported by the server. */
  show(now) {
    if (this.bar.hidden || this.seeking !== null || this.timer !== null) return;
    const length = Number(this.end - this.begin);
    this.slider.value = length > 0 ? Math.round(Number(now - this.begin) / length * STEPS) : STEPS;
    this.write(now);
  },
  write(now) {
    const length = Number(this.end - this.begin) / 1e9;
    const place = Math.min(length, Math.max(0, Number(now - this.begin) / 1e9));
    this.slider.style.setProperty("--share", `${this.slider.value / STEPS * 100}%`);
    this.text.textContent = `${placeText(place, length)} / ${placeText(length, length)}`;
  },

  seekSoon() {
    this.wanted = this.begin + (this.end - this.begin) * BigInt(this.slider.value) / BigInt(STEPS);
    this.write(this.wanted);
    this.timer ??= setTimeout(() => { this.timer = null; this.control(this.status === PLAYING, this.wanted); }, SEEK_MS);
  },
  control(play, place = null) {
    const name = `${REQUEST}${++this.requests}`, id = new TextEncoder().encode(name);
    if (place !== null) this.seeking = name;
    const frame = new DataView(new ArrayBuffer(19 + id.length));
    frame.setUint8(0, 3);
    frame.setUint8(1, play ? 0 : 1);
    frame.setFloat32(2, this.speed, true);
    frame.setUint8(6, place === null ? 0 : 1);
    frame.setBigUint64(7, place ?? 0n, true);
    frame.setUint32(15, id.length, true);
    new Uint8Array(frame.buffer).set(id, 19);
    this.sendBinary(frame.buffer);
  },
};

function placeText(seconds, longest) {
  const whole = Math.floor(seconds), two = (n) => String(n).padStart(2, "0");
  const hours = longest >= 3600 ? `${Math.floor(whole / 3600)}:` : "";
  const minutes = Math.floor(whole / 60) % 60;
  return `${hours}${hours ? two(minutes) : minutes}:${two(whole % 60)}.${Math.floor(seconds * 10) % 10}`;
}
