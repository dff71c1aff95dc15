import { expect, test } from "vitest";
import { LogHistory } from "../src/robot/log_history";
import { FakeConnection } from "./fake_connection";

function line(msg: string): object {
  return { stamp: { sec: 1, nanosec: 5 }, level: 20, name: "planner", msg, file: "node.py", function: "plan", line: 7 };
}

test("lines from before a panel opened are kept", () => {
  const connection = new FakeConnection();
  const log = new LogHistory(connection);
  connection.send("/rosout", line("goal reached"));
  let changes = 0;
  const end = log.onChange(() => { changes += 1; });
  connection.send("/rosout", line("idle"));
  expect(log.entries.map(({ text }) => text)).toEqual(["goal reached", "idle"]);
  expect(log.entries[0]).toMatchObject({ stampNs: 1_000_000_005n, level: 20, node: "planner", place: "node.py:7 plan" });
  expect([changes, log.total]).toEqual([1, 2]);
  end();
  connection.send("/rosout", line("more"));
  expect(changes).toBe(1);
});

test("memory is bounded, and a seek in a recording begins again", () => {
  const connection = new FakeConnection();
  const log = new LogHistory(connection);
  for (let index = 0; index < 6000; index += 1) connection.send("/rosout", line(String(index)));
  expect(log.entries.length).toBeLessThanOrEqual(5500);
  expect(log.entries.at(-1)?.text).toBe("5999");
  expect(log.total).toBe(6000);
  connection.emit("reset", { topics: "all" });
  expect(log.entries.length).toBeGreaterThan(0);
  connection.playback = {} as never;
  connection.emit("reset", { topics: "all" });
  expect(log.entries).toEqual([]);
});
