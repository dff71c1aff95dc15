import { afterEach, expect, test, vi } from "vitest";
import { RunServices } from "../../src/panels/run_services";
import { FakeConnection } from "../fake_connection";

const DONE = Promise.resolve({ result: { result: 1, error_message: "" } }) as Promise<never>;

afterEach(() => vi.useRealTimers());

test("a reset drops the goal, places the robot and clears the maps, in this order", async () => {
  vi.useFakeTimers();
  const connection = new FakeConnection();
  const calls: string[] = [];
  connection.services.set("/global_costmap/clear_entirely_global_costmap", "nav2_msgs/srv/ClearEntireCostmap");
  connection.addTopic("/ground_truth", "nav_msgs/msg/Odometry");
  connection.callService = (name) => {
    calls.push(name);
    return DONE;
  };
  connection.nowNs = 5n;
  const done = new RunServices(connection, "/sim/").reset();
  await vi.advanceTimersByTimeAsync(0);
  expect(connection.published.map(([topic]) => topic)).toEqual(["/cancel_goal"]);
  const pose = { position: { x: 1, y: 2, z: 0 } };
  connection.send("/ground_truth", { header: { frame_id: "map" }, pose: { pose } });
  expect(connection.published).toHaveLength(1); // from before the reset
  connection.nowNs = 6n;
  connection.send("/ground_truth", { header: { frame_id: "map" }, pose: { pose } });
  await vi.advanceTimersByTimeAsync(400);
  await done;
  expect(connection.published[1]).toMatchObject(["/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", { pose: { pose } }]);
  expect(calls).toEqual(["/sim/reset_simulation", "/global_costmap/clear_entirely_global_costmap"]);
});

test("a paused simulation is reset without ground truth", async () => {
  vi.useFakeTimers();
  const connection = new FakeConnection();
  connection.addTopic("/ground_truth", "nav_msgs/msg/Odometry");
  connection.callService = () => DONE;
  const done = new RunServices(connection, "/sim/").reset();
  await vi.advanceTimersByTimeAsync(2000);
  await done;
  expect(connection.isSubscribed("/ground_truth")).toBe(false);
});
