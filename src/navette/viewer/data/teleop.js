// Teleoperation by keys: a velocity command at 10 Hz while a key is held, then zero.
"use strict";

const KEYS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };
const SPEED_MPS = 0.5, TURN_RADPS = 0.8, PERIOD_MS = 100;

function driveByKeys(target, command) {
  const held = new Set();
  let timer = null;
  const beat = () => {
    const sum = [...held].reduce(([v, w], key) => [v + KEYS[key][0], w + KEYS[key][1]], [0, 0]);
    command(sum[0] * SPEED_MPS, sum[1] * TURN_RADPS);
    if (held.size === 0) { clearInterval(timer); timer = null; }
  };
  const release = () => { if (held.size) { held.clear(); beat(); } };
  target.addEventListener("keydown", (event) => {
    if (!(event.key in KEYS) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    held.add(event.key);
    if (timer === null) { beat(); timer = setInterval(beat, PERIOD_MS); }
  });
  target.addEventListener("keyup", (event) => { if (held.delete(event.key) && held.size === 0) beat(); });
  target.addEventListener("blur", release);
}
