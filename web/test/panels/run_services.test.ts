import { expect, test } from "vitest";
import { RunServices } from "../../src/panels/run_services";
import { FakeConnection } from "../fake_connection";

test("a reset drops the goal first; the simulation places the robot and clears the maps", async () => {
  const connection = new FakeConnection();
  const calls: string[] = [];
  connection.callService = (name) => {
    calls.push(name);
    return Promise.resolve({ result: { result: 1, error_message: "" } }) as Promise<never>;
  };
  await new RunServices(connection, "/sim/").reset();
  expect(connection.published.map(([topic]) => topic)).toEqual(["/cancel_goal"]);
  expect(calls).toEqual(["/sim/reset_simulation"]);
});

test("a refused reset states the reason", async () => {
  const connection = new FakeConnection();
  connection.callService = () => Promise.resolve({ result: { result: 104, error_message: "not while recording" } }) as Promise<never>;
  await expect(new RunServices(connection, "/sim/").reset()).rejects.toThrow("not while recording");
});
