/** Teleoperation: arrow keys and a stick on the screen. Whatever is let go stops the robot. */

import type { Operator } from "../robot/operator";
import { h } from "../ui/dom";

export const SPEED_MPS = 0.5;
export const TURN_RADPS = 0.8;

const KEYS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowUp: [1, 0],
  ArrowDown: [-1, 0],
  ArrowLeft: [0, 1],
  ArrowRight: [0, -1],
};

/** Whether letters and arrows are the element's own. */
export function takesKeys(element: EventTarget | null): boolean {
  return element instanceof Element && element.closest("input:not([type=checkbox]), select, textarea, [contenteditable], [role=slider], [role=tab], [role=menu]") !== null;
}

/** Whether Space is the element's own; a tab and a slider have other keys, and Stop comes first. */
export function takesSpace(element: EventTarget | null): boolean {
  if (!(element instanceof Element)) return false;
  return element.matches("input[type=checkbox]") || (takesKeys(element) && !element.matches("[role=tab], input[type=range]"));
}

/** Drives while keys are held. The keydown handler publishes before anything else runs. */
export function driveByKeys(operator: Operator): void {
  const held = new Set<string>();

  const update = (): void => {
    const sum = (axis: 0 | 1): number => [...held].reduce((total, key) => total + (KEYS[key]?.[axis] ?? 0), 0);
    operator.drive(sum(0) * SPEED_MPS, sum(1) * TURN_RADPS);
  };
  const letGo = (): void => {
    if (held.size === 0) return;
    held.clear();
    update();
  };

  const takes = (event: KeyboardEvent): boolean => {
    const isTaken = event.key === " " ? takesSpace(event.target) : takesKeys(event.target);
    return !(isTaken || event.ctrlKey || event.metaKey || event.altKey) && operator.robot.driveTopic !== undefined;
  };

  addEventListener(
    "keydown",
    (event) => {
      if (event.key === " " && takes(event)) {
        event.preventDefault();
        if (!event.repeat) operator.stop();
      }
      if (!(event.key in KEYS) || !takes(event)) return;
      event.preventDefault();
      if (event.repeat || held.has(event.key)) return;
      held.add(event.key);
      update();
    },
    { capture: true },
  );
  addEventListener("keyup", (event) => {
    if (held.delete(event.key)) update();
    if (event.key === " " && takes(event)) event.preventDefault(); // presses no button
  });
  // Without the focus a released key is not reported.
  for (const lost of ["blur", "pagehide"]) addEventListener(lost, letGo);
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) letGo();
  });
  document.addEventListener("focusin", (event) => {
    if (takesKeys(event.target)) letGo();
  });
}

/** A stick: forward and turn by how far the thumb is moved. */
export function makeStick(operator: Operator): HTMLElement {
  const thumb = h("i", { class: "thumb" });
  const stick = h(
    "div",
    { class: "stick", role: "application", "aria-label": "Drive: hold and move. The arrow keys do the same.", tabindex: "-1" },
    thumb,
  );
  let holder: number | null = null;

  const letGo = (): void => {
    if (holder === null) return;
    holder = null;
    operator.drive(0, 0);
    thumb.style.transform = "";
    stick.classList.remove("held");
  };
  const move = (event: PointerEvent): void => {
    const { left, top, width } = stick.getBoundingClientRect();
    const radius = width / 2;
    const [dx, dy] = [event.clientX - left - radius, event.clientY - top - radius];
    const far = Math.hypot(dx, dy);
    const reach = 0.72 * radius;
    const scale = far > reach ? reach / far : 1;
    const [x, y] = [(dx * scale) / reach, (dy * scale) / reach];
    const dead = (value: number): number => (Math.abs(value) < 0.12 ? 0 : value);
    operator.drive(-dead(y) * SPEED_MPS || 0, -dead(x) * TURN_RADPS || 0);
    thumb.style.transform = `translate(${dx * scale}px, ${dy * scale}px)`;
  };

  stick.addEventListener("pointerdown", (event) => {
    if (holder !== null) return;
    event.preventDefault();
    holder = event.pointerId;
    stick.setPointerCapture(event.pointerId);
    stick.classList.add("held");
    move(event);
  });
  stick.addEventListener("pointermove", (event) => {
    if (event.pointerId === holder) move(event);
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
    stick.addEventListener(end, (event) => {
      if (event.pointerId === holder) letGo();
    });
  }
  for (const lost of ["blur", "pagehide"]) addEventListener(lost, letGo);
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) letGo();
  });
  return stick;
}
