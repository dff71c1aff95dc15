// Token of the live view: from the address (#token=…), or from the login dialog. Kept for this tab.
"use strict";

const login = {
  token: "",
  dialog: null,
  onToken: () => {},

  /** Read the token; call `onToken` now, and whenever another one was entered. */
  start(dialog, onToken) {
    this.dialog = dialog;
    this.onToken = onToken;
    const given = /^#token=(.+)$/.exec(location.hash);
    if (given) {
      this.keep(decodeURIComponent(given[1]));
      history.replaceState(null, "", location.pathname); // out of the address bar and the history
    } else this.token = sessionStorage.getItem("token") ?? "";
    const form = dialog.querySelector("form");
    form.onsubmit = async (event) => {
      event.preventDefault();
      this.keep(form.token.value.trim());
      if (!(await this.isRefused())) dialog.close();
    };
    dialog.oncancel = (event) => event.preventDefault(); // nothing works without a token
    addEventListener("hashchange", () => location.reload()); // the address with a token, in the same tab
    onToken();
  },

  keep(token) {
    this.token = token;
    sessionStorage.setItem("token", token);
    this.onToken();
  },

  /** The query of addresses that need the token. */
  get query() { return this.token && `?token=${encodeURIComponent(this.token)}`; },

  /** Whether the server requires another token; if so, the dialog asks for it. */
  async isRefused() {
    const response = await fetch(`/health${this.query}`).catch(() => null); // null: not reachable
    if (response?.status !== 401 && response?.status !== 429) return false;
    const { form, hint } = { form: this.dialog.querySelector("form"), hint: this.dialog.querySelector(".hint") };
    hint.classList.toggle("bad", Boolean(this.token));
    if (response.status === 429) hint.textContent = `Too many wrong tokens. Wait ${/\d+/.exec(await response.text()) ?? "a few"} seconds.`;
    else if (this.token) hint.textContent = "This token is not valid. A new run has a new token.";
    if (!this.dialog.open) this.dialog.showModal();
    form.token.select();
    return true;
  },

  /** Return once the server accepts the token, or cannot be asked. */
  async permission() {
    while (await this.isRefused()) await new Promise((resolve) => this.dialog.addEventListener("close", resolve, { once: true }));
  },
};
