/** A button that opens a small card below it: menus and settings. */

import { h } from "../ui/dom";
import { icon } from "../ui/icons";

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
  card.addEventListener("toggle", (event) => {
    if ((event).newState === "open") place(card, button);
  });
  return { button, card, close };
}

/** Below the button, or above it where there is more room. */
function place(card: HTMLElement, button: HTMLElement): void {
  const at = button.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = card;
  const left = Math.max(8, Math.min(at.right - width, innerWidth - width - 8));
  const isBelow = at.bottom + height + 8 < innerHeight || at.top < height;
  card.style.left = `${at.left + width + 8 < innerWidth && at.left < innerWidth / 2 ? Math.max(8, at.left) : left}px`;
  card.style.top = `${isBelow ? Math.min(at.bottom + 6, innerHeight - height - 8) : at.top - height - 6}px`;
}

/** A row of a menu. */
export function menuItem(text: string, act: () => void, iconName?: string, note?: string): HTMLButtonElement {
  return h("button", { class: "item", onclick: act }, iconName ? icon(iconName) : null, h("span", {}, text), note ? h("small", {}, note) : null);
}
