/** The token of the live view: from the address (#token=…), or from the dialog. Kept for this tab. */

import { h, setText } from "../ui/dom";

const KEY = "token";

/** Read the token from the address, and take it out of the address bar and the history. */
export function storedToken(): string {
  const given = /^#token=(.+)$/.exec(location.hash)?.[1];
  if (given) {
    sessionStorage.setItem(KEY, decodeURIComponent(given));
    history.replaceState(null, "", location.pathname + location.search);
  }
  addEventListener("hashchange", () => location.reload()); // the address with a token, in the same tab
  return sessionStorage.getItem(KEY) ?? "";
}

export class LoginDialog {
  readonly element: HTMLDialogElement;
  readonly #hint = h("p", { class: "hint" }, "A login of the form name:password works too.");
  readonly #input = h("input", {
    name: "token", type: "password", autocomplete: "current-password", spellcheck: "false", required: true, autofocus: true,
  });

  /** @param onToken called with what was entered. */
  constructor(onToken: (token: string) => void) {
    const form = h(
      "form",
      { class: "login", onsubmit: (event: SubmitEvent) => { event.preventDefault(); onToken(this.#input.value.trim()); } },
      h("h2", { id: "login-title" }, "Sign in to this robot"),
      h("p", {}, "The terminal that runs Navette prints an address with the token. Open that address, or paste the token here."),
      h("label", {}, "Token", this.#input),
      this.#hint,
      h("button", { class: "main" }, "Sign in"),
    );
    this.element = h("dialog", { id: "login", "aria-labelledby": "login-title" }, form);
    this.element.addEventListener("cancel", (event) => event.preventDefault()); // nothing works without a token
  }

  /** Show it with the server's reason. */
  ask(reason: string, isWrong: boolean): void {
    setText(this.#hint, reason);
    this.#hint.classList.toggle("bad", isWrong);
    if (!this.element.open) this.element.showModal();
    this.#input.select();
  }

  close(): void {
    if (this.element.open) this.element.close();
  }
}

export function keepToken(token: string): void {
  sessionStorage.setItem(KEY, token);
  location.reload();
}
