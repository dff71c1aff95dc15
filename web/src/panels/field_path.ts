/**
 * Paths to numbers in messages: `/odom/filtered.twist.twist.linear.x`, `/lidar.ranges[180]`,
 * `/joint_states.position[-1]`; `.@length` is the length of an array, `.@yaw` the heading of a
 * quaternion and `.@norm` the length of a vector.
 */

export interface FieldPath {
  readonly topic: string;
  readonly steps: readonly (string | number)[];
}

/** Parse a path; null if it is none. Topics contain no dot, fields no slash. */
export function parsePath(text: string): FieldPath | null {
  const found = /^(\/[^.\s[]+)((?:\.@?\w+|\[-?\d+\])+)$/.exec(text.trim());
  if (!found) return null;
  const steps = [...found[2]!.matchAll(/\.(@?\w+)|\[(-?\d+)\]/g)].map((step) => step[1] ?? Number(step[2]));
  return { topic: found[1]!, steps };
}

export function pathText({ topic, steps }: FieldPath): string {
  return topic + steps.map((step) => (typeof step === "number" ? `[${step}]` : `.${step}`)).join("");
}

/** The number at a path of a message: booleans are 0 and 1, times seconds; null if there is none. */
export function numberAt(message: unknown, steps: readonly (string | number)[]): number | null {
  let at: unknown = message;
  for (const step of steps) {
    if (at === null || typeof at !== "object") return null;
    if (typeof step === "number") {
      const list = at as ArrayLike<unknown>;
      at = list[step < 0 ? list.length + step : step];
    } else if (step.startsWith("@")) at = derived(at as Record<string, unknown>, step);
    else at = (at as Record<string, unknown>)[step];
  }
  return asNumber(at);
}

export function asNumber(value: unknown): number | null {
  if (typeof value === "number") return value;
  if (typeof value === "boolean") return value ? 1 : 0;
  if (typeof value === "bigint") return Number(value);
  if (value !== null && typeof value === "object" && "sec" in value && "nanosec" in value) {
    return Number(value.sec) + Number(value.nanosec) / 1e9;
  }
  return null;
}

function derived(value: Record<string, unknown>, step: string): number | null {
  const [x, y, z, w] = ["x", "y", "z", "w"].map((name) => (typeof value[name] === "number" ? value[name] : 0)) as [number, number, number, number];
  switch (step) {
    case "@length":
      return typeof value["length"] === "number" ? value["length"] : null;
    case "@norm":
      return Math.hypot(x, y, z);
    case "@yaw":
      return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
    default:
      return null;
  }
}

/** Paths to all numbers of a message, for suggestions; of an array the first elements only. */
export function numericPaths(topic: string, message: unknown, most = 200): string[] {
  const found: string[] = [];
  const visit = (value: unknown, path: string, depth: number): void => {
    if (found.length >= most || depth > 8) return;
    if (asNumber(value) !== null) {
      found.push(path);
      return;
    }
    if (value === null || typeof value !== "object") return;
    if (Array.isArray(value) || ArrayBuffer.isView(value)) {
      const list = value as unknown as ArrayLike<unknown>;
      found.push(`${path}.@length`);
      for (let index = 0; index < Math.min(list.length, 3); index += 1) visit(list[index], `${path}[${index}]`, depth + 1);
      return;
    }
    const fields = value as Record<string, unknown>;
    if ("x" in fields && "w" in fields) found.push(`${path}.@yaw`);
    else if ("x" in fields && "y" in fields && "z" in fields) found.push(`${path}.@norm`);
    for (const [name, field] of Object.entries(fields)) visit(field, `${path}.${name}`, depth + 1);
  };
  visit(message, topic, 0);
  return found;
}
