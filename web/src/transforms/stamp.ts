/** builtin_interfaces/Time and nanoseconds. */

export interface Stamp {
  readonly sec: number;
  readonly nanosec: number;
}

export function nanosecondsOf({ sec, nanosec }: Stamp): bigint {
  return BigInt(sec) * 1_000_000_000n + BigInt(nanosec);
}

export function stampOf(ns: bigint): Stamp {
  return { sec: Number(ns / 1_000_000_000n), nanosec: Number(ns % 1_000_000_000n) };
}
