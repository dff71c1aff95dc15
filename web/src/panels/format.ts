/** Numbers, sizes and times as text. */

/** At most `digits` significant digits, without an exponent for ordinary sizes. */
export function numberText(value: number, digits = 6): string {
  if (Number.isNaN(value)) return "NaN";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  // An exponent is shorter than zeros.
  const isTiny = value !== 0 && Math.abs(value) < 1e-4;
  const text = isTiny ? Number(value.toPrecision(digits)).toExponential() : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

export function rateText(hz: number | null): string {
  if (hz === null) return "–";
  if (hz === 0) return "0";
  return hz >= 100 ? hz.toFixed(0) : hz >= 10 ? hz.toFixed(1) : hz.toFixed(2);
}

/** Decimal units, as network tools print them. */
export function bytesText(bytes: number): string {
  const units = ["B", "kB", "MB", "GB"];
  let value = bytes;
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${unit > 0 && value < 100 ? value.toFixed(1) : value.toFixed(0)} ${units[unit]!}`;
}

/** Minutes, seconds and tenths; hours where `longest` has any. */
export function clockText(seconds: number, longest = seconds): string {
  const whole = Math.floor(seconds);
  const two = (value: number): string => String(value).padStart(2, "0");
  const hours = longest >= 3600 ? `${Math.floor(whole / 3600)}:` : "";
  const minutes = Math.floor(whole / 60) % 60;
  return `${hours}${hours ? two(minutes) : minutes}:${two(whole % 60)}.${Math.floor(seconds * 10) % 10}`;
}

/** A stamp of a log line: time of day for real time, seconds for simulated time. */
export function stampText(stampNs: bigint): string {
  const seconds = Number(stampNs) / 1e9;
  if (seconds < 1e8) return seconds.toFixed(3);
  const date = new Date(seconds * 1000);
  return `${date.toLocaleTimeString("en-GB")}.${String(date.getMilliseconds()).padStart(3, "0")}`;
}

/** `std_msgs/msg/String` → `String`. */
export function shortType(type: string): string {
  return type.slice(type.lastIndexOf("/") + 1);
}

/** Offer a file to the person at the page. */
export function download(name: string, content: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
