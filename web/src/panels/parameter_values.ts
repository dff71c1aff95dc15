/** Values of parameters as text and back, their units, ranges and choices. */

import type { ParameterInfo, ParameterValue } from "../connection/connection";

const SUFFIXES: readonly (readonly [RegExp, string])[] = [
  [/_mps2$/, "m/s²"], [/_radps2$/, "rad/s²"], [/_mps3$/, "m/s³"], [/_mps$/, "m/s"], [/_radps$/, "rad/s"],
  [/_rad$/, "rad"], [/_deg$/, "°"], [/_hz$/, "Hz"], [/_ms$/, "ms"], [/_s$/, "s"], [/_m$/, "m"], [/_kg$/, "kg"], [/_px$/, "px"],
];

/** The unit that the description ends with, else that of the name's suffix. */
export function unitOf(name: string, meaning: string): string {
  const declared = /\[([^\]]+)\]$/.exec(meaning);
  return declared ? declared[1]! : (SUFFIXES.find(([suffix]) => suffix.test(name))?.[1] ?? "");
}

/** The values of a text that has only some: "one of a, b, c". */
export function choicesOf(allowed: string): string[] | null {
  const found = /^one of (.+)/.exec(allowed);
  return found ? found[1]!.split(", ") : null;
}

/** Range of a slider: declared by the node, or from 0 to twice the value. */
export function rangeOf({ value, low, high, step, isWhole }: ParameterInfo): { low: number; high: number; step: number } | null {
  if (typeof value !== "number") return null;
  const most = value === 0 ? 1 : 2 * Math.abs(value);
  const range = low !== undefined && high !== undefined ? { low, high } : { low: value < 0 ? -most : 0, high: most };
  return { ...range, step: step ?? (isWhole ? 1 : roundStep(range.high - range.low)) };
}

/** A 1, 2 or 5 and its zeros: some 100 to 250 steps over the span. */
function roundStep(span: number): number {
  const least = span / 250;
  const unit = 10 ** Math.floor(Math.log10(least));
  return Number(((([1, 2, 5].find((digit) => digit * unit >= least) ?? 10) * unit)).toPrecision(1));
}

export function valueText(value: ParameterValue): string {
  if (typeof value === "number") return String(Number(value.toPrecision(6)));
  if (typeof value === "string") return value;
  if (typeof value === "boolean") return String(value);
  return JSON.stringify(Array.from(value as ArrayLike<unknown>));
}

/** What was typed, as the kind of value that the parameter has; an Error with the reason if it is none. */
export function parseValue(typed: string | boolean, current: ParameterValue): ParameterValue | Error {
  if (typeof typed === "boolean" || typeof current === "string") return typed;
  if (typeof current === "number") {
    const text = typed.trim().replace(",", ".").replace("−", "-");
    const value = Number(text);
    return text !== "" && Number.isFinite(value) ? value : new Error(`${typed || "nothing"} is not a number`);
  }
  try {
    const value: unknown = JSON.parse(typed);
    if (!Array.isArray(value)) throw new Error();
    return current instanceof Uint8Array ? Uint8Array.from(value as number[]) : (value as number[]);
  } catch {
    return new Error("not a list; expected for example [1, 2]");
  }
}
