/**
 * Drawing in turns: input comes first.
 *
 * All drawing of the page goes through one queue. After a frame the page rests as long as the
 * frame took, so that on a slow machine a key never waits behind a row of frames.
 */

import type { Dispose } from "../connection/connection";

/** Most ms of a frame; what is left is done in the next. */
const BUDGET_MS = 12;
/** Rest after a frame, as a multiple of its duration. */
const REST_FACTOR = 1;
const LONGEST_REST_MS = 200;

type Task = () => void;

const queue = new Set<Task>();
let isScheduled = false;

/** Run `task` in the next frame that has room; several calls before it run it once. */
export function nextFrame(task: Task): void {
  queue.add(task);
  schedule(0);
}

/** Run `task` at most `rateHz` times a second, from now until disposed, while the page is visible. */
export function every(rateHz: number, task: Task): Dispose {
  const timer = setInterval(() => {
    if (!document.hidden) nextFrame(task);
  }, 1000 / rateHz);
  return () => {
    clearInterval(timer);
    queue.delete(task);
  };
}

function schedule(restMs: number): void {
  if (isScheduled) return;
  isScheduled = true;
  const begin = (): void => void requestAnimationFrame(run);
  if (restMs < 4) begin();
  else setTimeout(begin, restMs);
}

function run(): void {
  isScheduled = false;
  const begin = performance.now();
  for (const task of queue) {
    queue.delete(task);
    try {
      task();
    } catch (error) {
      reportError(error); // one display that fails does not stop the others
    }
    if (performance.now() - begin > BUDGET_MS) break;
  }
  if (queue.size > 0 || performance.now() - begin > BUDGET_MS) {
    schedule(Math.min(REST_FACTOR * (performance.now() - begin), LONGEST_REST_MS));
  }
}
