import { beforeEach, describe, expect, it, vi } from "vitest";
import { Duties, headlineOf, nodeProblem } from "../src/robot/headline";
import { Operator } from "../src/robot/operator";
import { RobotState } from "../src/robot/robot_state";
import { ageText, fixed, parseNumber } from "../src/robot/text";
import { driveByKeys, makeStick } from "../src/tools/teleop";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

const status = (message: string, values: Record<string, string> = {}): object => ({
  level: 0, name: "planner", message, hardware_id: "", values: Object.entries(values).map(([key, value]) => ({ key, value })),
});
const odometry = (x: number): object => ({
  header: { frame_id: "odom", stamp: { sec: 0, nanosec: 0 } },
  child_frame_id: "base_link",
  pose: { pose: { position: { x, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } }, covariance: [] },
  twist: { twist: { linear: { x: 0.5, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0 } } },
});

let connection: FakeConnection;
let transforms: TransformTree;
let robot: RobotState;
let operator: Operator;
const answers: string[] = [];

beforeEach(() => {
  connection = new FakeConnection();
  transforms = new TransformTree();
  robot = new RobotState(connection, transforms);
  answers.length = 0;
  operator = new Operator(robot, (text) => answers.push(text));
  for (const topic of ["/goal_point", "/goal_pose", "/cmd_vel_teleop", "/cancel_goal"]) {
    connection.addTopic(topic, "x", { subscribers: ["/missions"], isPublished: false });
  }
  vi.useFakeTimers();
});

describe("the robot", () => {
  it("has a transform from its odometry where nothing publishes one", () => {
    connection.addTopic("/odom", "nav_msgs/msg/Odometry");
    connection.send("/odom", odometry(2));
    connection.send("/odom", odometry(3));
    expect(robot.baseIn("odom")?.translation).toEqual([3, 0, 0]);
    transforms.set({ parent: "odom", child: "base_link", parent_T_child: { translation: [7, 0, 0], rotation: [0, 0, 0, 1] }, stampNs: 5n, source: "tf" });
    connection.send("/odom", odometry(4));
    expect(robot.baseIn("odom")?.translation).toEqual([7, 0, 0]);
  });

  it("follows its odometry after a seek, too", () => {
    connection.addTopic("/odom", "nav_msgs/msg/Odometry");
    connection.send("/odom", odometry(2));
    connection.emit("reset", { topics: "all" });
    expect(robot.motion).toBeNull();
    connection.send("/odom", odometry(5));
    expect(robot.placeOfMotion()?.x).toBe(5);
  });

  it("has the goal of any node, without a planner's status", () => {
    connection.send("/goal_point", { header: { frame_id: "map" }, point: { x: 1, y: 2, z: 0 } });
    expect(robot.goal).toEqual({ frame: "map", x: 1, y: 2, yaw: null });
    connection.send("/planner/status", status("canceled"));
    expect(robot.goal).toBeNull();
  });

  it("states why its goal was refused, once", () => {
    operator.sendGoal({ frame: "map", x: 1, y: 2, yaw: null });
    const refused = status("waiting_for_goal", { goal_x: "1.000", goal_y: "2.000", goal_id: "4", result: "goal_occupied" });
    connection.send("/planner/status", refused);
    connection.send("/planner/status", refused);
    expect(answers).toEqual(["Goal 1.0, 2.0 sent.", "Goal refused: goal occupied."]);
  });

  it("sends the next waypoint on arrival", () => {
    operator.sendWaypoints([{ frame: "map", x: 1, y: 0, yaw: null }, { frame: "map", x: 2, y: 0, yaw: null }]);
    connection.send("/planner/status", status("reached", { goal_x: "1.000", goal_y: "0.000", goal_id: "1", result: "reached" }));
    expect(connection.published.map(([topic]) => topic)).toEqual(["/goal_point", "/goal_point"]);
    connection.send("/planner/status", status("reached", { goal_x: "2.000", goal_y: "0.000", goal_id: "2", result: "reached" }));
    expect(answers.at(-1)).toBe("All waypoints reached.");
  });
});

describe("headlines", () => {
  it("name what is wrong first", () => {
    expect(headlineOf(robot, new Duties()).text).toBe("Running");
    connection.send("/planner/status", status("following", { goal_x: "6.2", goal_y: "-3.4", distance_left_m: "4.25" }));
    expect(headlineOf(robot, new Duties())).toEqual({ text: "Driving to 6.2, −3.4", detail: "4.3 m to go · planner: following", isBad: false });
    connection.nowNs = 5_000_000_000n;
    expect(headlineOf(robot, new Duties()).text).toBe("Planner has stopped responding");
    connection.nodes = [{ name: "/control", state: "gone", since: 3 }];
    connection.send("/control/status", status("following"));
    expect(headlineOf(robot, new Duties()).text).toBe("Control is gone");
    connection.status = { state: "lost", reason: "" };
    expect(headlineOf(robot, new Duties()).text).toBe("Not connected");
  });

  it("name the goal of a planner without a status", () => {
    connection.send("/goal_point", { header: { frame_id: "map", stamp: { sec: 0, nanosec: 0 } }, point: { x: 2, y: 1, z: 0 } });
    connection.send("/control/status", status("following"));
    expect(headlineOf(robot, new Duties())).toEqual({ text: "Driving to 2.0, 1.0", detail: "Control: following", isBad: false });
    connection.send("/control/status", status("reached"));
    expect(headlineOf(robot, new Duties()).text).toBe("Reached 2.0, 1.0");
  });

  it("name who drives instead of navigation", () => {
    const arbiter = (message: string, nodes: string): object => ({ ...status(message, { masked_topics: "/cmd_vel_nav", nodes }) });
    connection.send("/commander", arbiter("operator", "/viewer"));
    expect(headlineOf(robot, new Duties())).toEqual({ text: "Driven by operator (viewer)", detail: "Navigation waits with its goal", isBad: false });
    connection.send("/commander", arbiter("pause", ""));
    expect(headlineOf(robot, new Duties()).text).toBe("Paused");
  });

  it("count nodes", () => {
    expect(nodeProblem([{ name: "/a", state: "gone", since: 1 }, { name: "/b_c", state: "silent", since: 100 }])).toEqual(["A and b c are missing", "Gone or not responding for 2 min."]);
  });
});

describe("teleoperation", () => {
  const drives = (): [number, number][] =>
    connection.published.filter(([topic]) => topic === "/cmd_vel_teleop").map(([, , twist]) => {
      const { linear, angular } = twist as { linear: { x: number }; angular: { z: number } };
      return [linear.x, angular.z];
    });
  const key = (type: string, name: string): boolean => dispatchEvent(new KeyboardEvent(type, { key: name }));

  it("publishes within the key press, repeats, and stops when it is let go", () => {
    driveByKeys(operator);
    key("keydown", "ArrowUp");
    expect(drives()).toEqual([[0.5, 0]]);
    key("keydown", "ArrowLeft");
    expect(drives().at(-1)).toEqual([0.5, 0.8]);
    vi.advanceTimersByTime(250);
    expect(drives()).toHaveLength(4);
    dispatchEvent(new Event("blur"));
    expect(drives().at(-1)).toEqual([0, 0]);
    vi.advanceTimersByTime(1000);
    expect(drives()).toHaveLength(5);
  });

  it("stops when the thumb leaves the stick", () => {
    const stick = makeStick(operator);
    stick.setPointerCapture = (): void => undefined;
    stick.getBoundingClientRect = (): DOMRect => new DOMRect(0, 0, 100, 100);
    const pointer = (type: string, x: number, y: number): boolean => stick.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x, clientY: y }));
    pointer("pointerdown", 50, 50);
    pointer("pointermove", 50, 0);
    expect(drives().at(-1)).toEqual([0.5, 0]);
    pointer("pointercancel", 50, 0);
    expect(drives().at(-1)).toEqual([0, 0]);
  });

  it("states why keys do not drive a stopped robot", () => {
    connection.send("/commander", status("emergency_stop"));
    operator.drive(0.5, 0);
    expect(answers.at(-1)).toBe("The emergency stop holds the robot: release it to drive.");
    operator.stop();
    expect(answers.at(-1)).toBe("");
  });

  it("repeats Stop until it is confirmed", () => {
    operator.stop();
    vi.advanceTimersByTime(250);
    expect(connection.published.filter(([topic]) => topic === "/emergency_stop")).toHaveLength(3);
    connection.send("/commander", status("emergency_stop"));
    vi.advanceTimersByTime(1000);
    expect(connection.published.filter(([topic]) => topic === "/emergency_stop")).toHaveLength(3);
  });
});

describe("texts", () => {
  it("have true minus signs and no minus zero", () => {
    expect([fixed(-0.001, 2), fixed(-1.5, 1), ageText(200)]).toEqual(["0.00", "−1.5", "3 min"]);
    expect([parseNumber("−12,5"), parseNumber("")]).toEqual([-12.5, NaN]);
  });
});
