/** What a panel displays before there is anything. */

import { h } from "../ui/dom";
import { icon, type IconName } from "../ui/icons";

export interface EmptyState {
  readonly element: HTMLElement;
  set(title: string, what: string): void;
}

export function emptyState(name: IconName, title: string, what: string): EmptyState {
  const strong = h("strong", {}, title);
  const text = h("p", {}, what);
  const element = h("div", { class: "empty" }, icon(name), strong, text);
  return {
    element,
    set(newTitle, newWhat) {
      if (strong.textContent !== newTitle) strong.textContent = newTitle;
      if (text.textContent !== newWhat) text.textContent = newWhat;
    },
  };
}
