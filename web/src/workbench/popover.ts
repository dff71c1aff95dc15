/**
 * A button that opens a card below it: menus, settings, the list of shortcuts.
 *
 * No card is modal and none covers Stop: the robot can be stopped at any moment.
 */

import { h } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";

/** Pixels to the edges of the page, from the button, and to Stop, which no shadow dims. */
const MARGIN = 8;
const BELOW = 6;
const SHADOW = 16;
/** A menu that is lower than this is moved over its button. */
const LOWEST = 144;
/** As often as Stop may move: a sheet opens, the window is resized. */
const RATE_HZ = 5;

export interface Popover {
  readonly button: HTMLButtonElement;
  readonly card: HTMLElement;
  close(): void;
}

let count = 0;

/** @param fill makes the content each time it opens. */
export function popover(label: string, iconName: string, fill: (close: () => void) => readonly Node[], text?: string): Popover {
  const id = `popover-${count++}`;
  const card = h("div", { id, class: "popover", popover: "auto" });
  const button = h("button", { class: "bare", popovertarget: id, "aria-label": label, title: label, "aria-haspopup": "true" }, icon(iconName), text ?? null);
  const close = (): void => card.hidePopover();
  card.addEventListener("beforetoggle", (event) => {
    if ((event).newState === "open") card.replaceChildren(...fill(close));
  });
  const place = (): void => {
    if (card.matches(":popover-open")) placeCard(card, button);
  };
  card.addEventListener("toggle", place);
  every(RATE_HZ, place);
  return { button, card, close };
}

function placeCard(card: HTMLElement, button: HTMLElement): void {
  const borders = card.offsetHeight - card.clientHeight;
  const size = { width: card.offsetWidth, height: card.scrollHeight + borders };
  const stop = document.querySelector("#stop")!.getBoundingClientRect();
  const { left, top, height } = menuPlace(button.getBoundingClientRect(), size, { width: innerWidth, height: innerHeight }, stop);
  Object.assign(card.style, { left: `${left}px`, top: `${top}px`, maxHeight: `${height}px` });
}

interface Size {
  readonly width: number;
  readonly height: number;
}

type Box = Pick<DOMRect, "left" | "top" | "right" | "bottom">;

/**
 * A card below its button, or above it where there is more room; off Stop, in pixels of the page.
 *
 * Beside Stop if there is room, else the card ends above Stop and scrolls.
 */
export function menuPlace(button: Box, card: Size, page: Size, stop: Box): { left: number; top: number; height: number } {
  const height = Math.min(card.height, page.height - 80);
  const isLeft = button.left + card.width + MARGIN < page.width && button.left < page.width / 2;
  const left = Math.max(MARGIN, isLeft ? button.left : Math.min(button.right, page.width - MARGIN) - card.width);
  const isBelow = button.bottom + height + MARGIN < page.height || button.top < height;
  const top = isBelow ? Math.min(button.bottom + BELOW, page.height - height - MARGIN) : button.top - height - BELOW;
  const [free, end] = [stop.left - SHADOW, stop.top - SHADOW];
  const isOffStop = left >= stop.right + SHADOW || left + card.width <= free || top >= stop.bottom + SHADOW || top + height <= end;
  if (isOffStop) return { left, top, height };
  const beside = free - card.width;
  if (beside >= MARGIN) return { left: beside, top, height };
  const begin = end - top >= Math.min(height, LOWEST) ? top : Math.max(MARGIN, end - height);
  return { left, top: begin, height: Math.min(height, end - begin) };
}

/** A row of a menu. */
export function menuItem(text: string, act: () => void, iconName?: string, note?: string): HTMLButtonElement {
  return h("button", { class: "item", onclick: act }, iconName ? icon(iconName) : null, h("span", {}, text), note ? h("small", {}, note) : null);
}
