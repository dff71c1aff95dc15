/** Parameters of all nodes with what their nodes declare, and pending changes. */

import type { Parameter } from "@foxglove/ws-protocol";
import type { ParameterInfo, ParameterValue } from "./connection";

export interface ParameterText {
  readonly name: string;
  readonly meaning: string;
  readonly allowed: string;
  readonly read_only: boolean;
  readonly low: number | null;
  readonly high: number | null;
  readonly step: number;
}

interface Pending {
  readonly name: string;
  readonly resolve: () => void;
  readonly reject: (reason: Error) => void;
  refusal: string;
}

export class ParameterStore {
  readonly infos = new Map<string, ParameterInfo>();
  readonly #wire = new Map<string, Parameter>();
  readonly #texts = new Map<string, ParameterText>();
  readonly #pending = new Map<string, Pending>();
  #requests = 0;

  /** Take values of the server; returns the names that changed. */
  take(parameters: readonly Parameter[], requestId?: string): string[] {
    const changed = parameters.filter(({ name, value, type }) => {
      const before = this.#wire.get(name);
      return value === undefined ? before : JSON.stringify(before?.value) !== JSON.stringify(value) || before?.type !== type;
    });
    for (const parameter of changed) {
      if (parameter.value === undefined) this.#wire.delete(parameter.name);
      else this.#wire.set(parameter.name, parameter);
      this.#refresh(parameter.name);
    }
    if (requestId !== undefined) this.#finish(requestId);
    return changed.map(({ name }) => name);
  }

  /** Take descriptions; returns the names of known parameters. */
  describe(texts: readonly ParameterText[]): string[] {
    for (const text of texts) {
      this.#texts.set(text.name, text);
      this.#refresh(text.name);
    }
    return texts.map(({ name }) => name).filter((name) => this.infos.has(name));
  }

  /** A status of the server; true if it is the reason of a refused change. */
  refuse(text: string): boolean {
    const pending = [...this.#pending.values()].find(({ name }) => text.startsWith("parameter ") && text.includes(name));
    if (!pending) return false;
    pending.refusal = text.replace(/^parameter '[^']*': /, "");
    return true;
  }

  /** Begin a change: the frame's content, and what becomes of it. */
  change(name: string, value: ParameterValue): { id: string; parameter: Parameter; done: Promise<void> } {
    const id = `set-${(this.#requests += 1)}`;
    const done = new Promise<void>((resolve, reject) => {
      this.#pending.set(id, { name, resolve, reject, refusal: "" });
    });
    const type = this.#wire.get(name)?.type;
    const plain = value instanceof Uint8Array ? btoa(String.fromCharCode(...value)) : value;
    return { id, parameter: type ? { name, value: plain, type } : { name, value: plain }, done };
  }

  /** The connection was lost. */
  clear(): string[] {
    const names = [...this.infos.keys()];
    this.infos.clear();
    this.#wire.clear();
    this.#texts.clear();
    for (const { reject } of this.#pending.values()) reject(new Error("not connected"));
    this.#pending.clear();
    return names;
  }

  #finish(id: string): void {
    const pending = this.#pending.get(id);
    if (!pending) return;
    this.#pending.delete(id);
    if (pending.refusal) pending.reject(new Error(pending.refusal));
    else pending.resolve();
  }

  #refresh(name: string): void {
    const wire = this.#wire.get(name);
    if (wire?.value === undefined) {
      this.infos.delete(name);
      return;
    }
    const text = this.#texts.get(name);
    const value = valueOf(wire);
    this.infos.set(name, {
      name,
      node: name.includes(".") ? name.slice(0, name.indexOf(".")) : "",
      value,
      isWhole: typeof value === "number" && Number.isInteger(value) && wire.type !== "float64",
      ...(text && {
        meaning: text.meaning,
        allowed: text.allowed,
        isReadOnly: text.read_only,
        ...(text.low !== null && text.high !== null && { low: text.low, high: text.high }),
        ...(text.step > 0 && { step: text.step }),
      }),
    });
  }
}

function valueOf({ value, type }: Parameter): ParameterValue {
  if (type === "byte_array" && typeof value === "string") return Uint8Array.from(atob(value), (c) => c.charCodeAt(0));
  return value as ParameterValue;
}
