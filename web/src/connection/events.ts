/** Typed events with listeners that can be removed. */

import type { Dispose } from "./connection";

export class Events<E> {
  readonly #listeners = new Map<keyof E, Set<(value: never) => void>>();

  on<K extends keyof E>(event: K, callback: (value: E[K]) => void): Dispose {
    let listeners = this.#listeners.get(event);
    if (!listeners) this.#listeners.set(event, (listeners = new Set()));
    listeners.add(callback);
    return () => listeners.delete(callback);
  }

  emit<K extends keyof E>(event: K, value: E[K]): void {
    for (const callback of [...(this.#listeners.get(event) ?? [])]) {
      try {
        (callback as (value: E[K]) => void)(value);
      } catch (error) {
        reportError(error); // one listener that fails does not stop the others
      }
    }
  }
}
