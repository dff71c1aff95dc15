/** Numbers, times and names as the page writes them. */

/** Fixed digits with a true minus sign, and no minus zero. */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text.replace("-", "−");
}

/** "waiting_for_goal" → "Waiting for goal". */
export function words(state: string): string {
  const text = state.replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

export function ageText(seconds: number): string {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
}

/** The robot's time: minutes and seconds of a simulation, or the time of day. */
export function clockText(ns: bigint): string {
  const seconds = Number(ns) / 1e9;
  if (seconds > 1e8) return new Date(seconds * 1000).toLocaleTimeString();
  return `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
}

export function speedText(factor: number | null): string {
  return factor === null ? "" : `${factor < 9.95 ? factor.toFixed(1) : Math.round(factor)}×`;
}

/** Number as typed: with a comma or a true minus sign too; NaN for another text. */
export function parseNumber(text: string): number {
  const plain = text.trim().replace(",", ".").replace("−", "-");
  return plain === "" ? NaN : Number(plain);
}
