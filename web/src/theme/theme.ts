/** The two themes: as the system prefers, or as the switch says. Colours are CSS variables. */

import type { Dispose } from "../connection/connection";

export type ThemeChoice = "system" | "light" | "dark";

export class Theme {
  readonly #key = "navette.theme";
  readonly #prefersDark = matchMedia("(prefers-color-scheme: dark)");
  readonly #listeners = new Set<() => void>();
  #colours = new Map<string, string>();

  constructor() {
    this.#prefersDark.addEventListener("change", () => this.#apply());
    this.#apply();
  }

  get choice(): ThemeChoice {
    const stored = localStorage.getItem(this.#key);
    return stored === "light" || stored === "dark" ? stored : "system";
  }

  get isDark(): boolean {
    return this.choice === "system" ? this.#prefersDark.matches : this.choice === "dark";
  }

  choose(choice: ThemeChoice): void {
    localStorage.setItem(this.#key, choice);
    this.#apply();
  }

  /** A colour of `theme.css` by its name without dashes: `colour("thread")` → "#bf3e0a". */
  colour(name: string): string {
    let value = this.#colours.get(name);
    if (value === undefined) {
      value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
      this.#colours.set(name, value);
    }
    return value;
  }

  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  #apply(): void {
    document.documentElement.dataset["theme"] = this.isDark ? "dark" : "light";
    this.#colours = new Map();
    // The frame of an installed page.
    document.querySelector('meta[name="theme-color"]')?.setAttribute("content", this.colour("card"));
    for (const callback of this.#listeners) callback();
  }
}
