/** Gestures on the scene: tap, drag with a tool, pan, turn, pinch, wheel, long press. */

export interface GestureTarget {
  /** A short press; `isSecondary`: the right button, or a long press. */
  tap(px: number, py: number, isSecondary: boolean): void;
  /** A drag begins: true if a tool takes it, else it moves the view. */
  beginDrag(px: number, py: number): boolean;
  drag(px: number, py: number): void;
  endDrag(px: number, py: number): void;
  cancelDrag(): void;
  move(fromX: number, fromY: number, toX: number, toY: number): void;
  turn(dx: number, dy: number): void;
  zoom(factor: number, px: number, py: number): void;
  /** The pointer is over a place, or has left. */
  hover(px: number | null, py: number | null): void;
}

const SLACK_PX = 4;
const LONG_PRESS_MS = 550;

export function listenToPointer(element: HTMLElement, target: GestureTarget): void {
  const pointers = new Map<number, readonly [number, number]>();
  let start: readonly [number, number] = [0, 0];
  let isMoved = false;
  let isTool = false;
  let isTurning = false;
  let spread = 0;
  let press: ReturnType<typeof setTimeout> | undefined;

  const at = (event: PointerEvent | WheelEvent): readonly [number, number] => {
    const { left, top } = element.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };

  element.addEventListener("pointerdown", (event) => {
    if (event.button === 1 || !(event.target instanceof HTMLCanvasElement)) return;
    element.setPointerCapture(event.pointerId);
    const place = at(event);
    pointers.set(event.pointerId, place);
    if (pointers.size > 1) {
      clearTimeout(press);
      if (isTool) target.cancelDrag();
      isTool = false;
      isMoved = true;
      spread = 0;
      return;
    }
    [start, isMoved, spread] = [place, false, 0];
    isTurning = event.button === 2 || event.ctrlKey;
    isTool = !isTurning && target.beginDrag(...place);
    if (event.pointerType === "touch") {
      press = setTimeout(() => {
        if (isMoved || pointers.size !== 1) return;
        isMoved = true; // no tap when it is lifted
        if (isTool) target.cancelDrag();
        isTool = false;
        target.tap(...place, true);
      }, LONG_PRESS_MS);
    }
  });

  element.addEventListener("pointermove", (event) => {
    const [x, y] = at(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      target.hover(x, y);
      return;
    }
    pointers.set(event.pointerId, [x, y]);
    if (pointers.size === 2) {
      pinch();
      return;
    }
    isMoved ||= Math.hypot(x - start[0], y - start[1]) > SLACK_PX;
    if (!isMoved || pointers.size > 2) return;
    if (isTool) target.drag(x, y);
    else if (isTurning) target.turn(x - before[0], y - before[1]);
    else target.move(before[0], before[1], x, y);
  });

  function pinch(): void {
    const [a, b] = [...pointers.values()];
    const now = Math.hypot(a![0] - b![0], a![1] - b![1]);
    if (spread > 0) target.zoom(now / spread, (a![0] + b![0]) / 2, (a![1] + b![1]) / 2);
    spread = now;
  }

  const end = (event: PointerEvent): void => {
    clearTimeout(press);
    if (!pointers.delete(event.pointerId) || pointers.size > 0) return;
    const [x, y] = at(event);
    const isDone = event.type === "pointerup";
    if (isTool && isMoved && isDone) target.endDrag(x, y);
    else if (isTool) target.cancelDrag();
    if (isDone && !isMoved) target.tap(x, y, isTurning);
    isTool = false;
  };
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  element.addEventListener("pointerleave", () => target.hover(null, null));
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener(
    "wheel",
    (event) => {
      if (!(event.target instanceof HTMLCanvasElement)) return;
      event.preventDefault();
      target.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), ...at(event));
    },
    { passive: false },
  );
}
