import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { encoderOf } from "../../src/connection/codec";
import type { Connection, Message } from "../../src/connection/connection";
import { connectTo } from "../../src/connection/foxglove";
import { FakeServer } from "./fake_server";

const STRING = { id: 1, topic: "/chatter", schemaName: "std_msgs/msg/String", schema: "string data" };
const text = (data: string): Uint8Array => encoderOf(STRING.schema).encode({ data });

let connection: Connection;

beforeEach(() => {
  vi.useFakeTimers();
  FakeServer.all.length = 0;
  vi.stubGlobal("WebSocket", FakeServer);
  vi.stubGlobal("fetch", () => Promise.reject(new Error("no page")));
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => setTimeout(callback, 1));
  connection = connectTo("ws://robot:8765");
  connection.connect();
});

afterEach(() => {
  vi.advanceTimersByTime(300); // the queue of drawing is the page's
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function subscribed(): number {
  const { subscriptions } = FakeServer.last.operations("subscribe").at(-1) as { subscriptions: { id: number }[] };
  return subscriptions[0]!.id;
}

describe("connecting", () => {
  it("requests graph, parameters and node states of a server that has them", () => {
    FakeServer.last.welcome();
    expect(connection.status).toEqual({ state: "live", reason: "" });
    const operations = FakeServer.last.sent.map((each) => (each as Record<string, unknown>)["op"]);
    expect(operations).toEqual(["subscribeConnectionGraph", "subscribeParameterUpdates", "getParameters", "subscribeNodes", "applyGridUpdates"]);
  });

  it("requests nothing of another server that has nothing", () => {
    FakeServer.last.welcome({ name: "foxglove_bridge", capabilities: [] });
    expect(FakeServer.last.sent).toEqual([]);
  });

  it("reports the loss and connects again by itself, later each time", async () => {
    FakeServer.last.welcome();
    const states: string[] = [];
    connection.on("status", ({ state }) => states.push(state));
    FakeServer.last.drop();
    await vi.advanceTimersByTimeAsync(600);
    expect(FakeServer.all).toHaveLength(2);
    FakeServer.last.drop();
    await vi.advanceTimersByTimeAsync(600);
    expect(FakeServer.all).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(600);
    expect(FakeServer.all).toHaveLength(3);
    FakeServer.last.welcome();
    expect(states).toEqual(["lost", "connecting", "lost", "connecting", "live"]);
  });

  it("stops at a refused token", async () => {
    vi.stubGlobal("fetch", () => Promise.resolve(new Response("", { status: 401 })));
    const own = connectTo(location.origin.replace(/^http/, "ws"));
    own.connect();
    FakeServer.last.drop();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(own.status).toMatchObject({ state: "lost", needsToken: true });
    expect(own.status.reason).toContain("token");
    expect(FakeServer.all).toHaveLength(2);
  });

  it("reports a reset when another program answers", async () => {
    FakeServer.last.welcome();
    let resets = 0;
    connection.on("reset", () => (resets += 1));
    FakeServer.last.drop();
    await vi.advanceTimersByTimeAsync(600);
    FakeServer.last.welcome({ sessionId: "2" });
    expect(resets).toBe(1);
  });
});

describe("subscriptions", () => {
  it("deliver decoded messages outside the socket's event, also of a topic that comes later", async () => {
    const received: unknown[] = [];
    connection.subscribe<{ data: string }>("/chatter", {}, ({ value, type, stampNs }) => received.push([value.data, type, stampNs]));
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING);
    FakeServer.last.message(subscribed(), 7n, text("hello"));
    expect(received).toEqual([]);
    await vi.advanceTimersByTimeAsync(20);
    expect(received).toEqual([["hello", "std_msgs/msg/String", 7n]]);
  });

  it("share one on the wire and end it with the last", () => {
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING);
    const ends = [1, 2].map(() => connection.subscribe("/chatter", {}, () => undefined));
    const count = (op: string): number => FakeServer.last.operations(op).length;
    ends[0]!();
    expect(count("subscribe") - count("unsubscribe")).toBe(1);
    ends[1]!();
    expect(count("subscribe") - count("unsubscribe")).toBe(0);
  });

  it("drop messages beyond their rate and deliver the newest", async () => {
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING);
    const slow: string[] = [];
    const all: string[] = [];
    connection.subscribe<{ data: string }>("/chatter", { rateHz: 10 }, ({ value }) => slow.push(value.data));
    connection.subscribe<{ data: string }>("/chatter", { every: true }, ({ value }) => all.push(value.data));
    for (let index = 0; index < 100; index += 1) {
      FakeServer.last.message(subscribed(), BigInt(index), text(String(index)));
      await vi.advanceTimersByTimeAsync(10);
    }
    await vi.advanceTimersByTimeAsync(200);
    expect(slow.length).toBeGreaterThan(5);
    expect(slow.length).toBeLessThan(14);
    expect(slow.at(-1)).toBe("99");
    expect(all).toHaveLength(100);
  });

  it("do not decode what is dropped, and decode once", async () => {
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING);
    const messages: Message[] = [];
    connection.subscribe("/chatter", {}, (message) => messages.push(message));
    FakeServer.last.message(subscribed(), 1n, new Uint8Array([0, 1])); // would fail
    FakeServer.last.message(subscribed(), 2n, text("good"));
    await vi.advanceTimersByTimeAsync(20);
    expect(messages).toHaveLength(1);
    expect(messages[0]!.value).toBe(messages[0]!.value);
  });

  it("remain over a reconnection", async () => {
    const received: unknown[] = [];
    connection.subscribe<{ data: string }>("/chatter", {}, ({ value }) => received.push(value.data));
    for (const round of ["first", "second"]) {
      FakeServer.last.welcome();
      FakeServer.last.advertise({ ...STRING, id: received.length + 5 });
      FakeServer.last.message(subscribed(), 1n, text(round));
      await vi.advanceTimersByTimeAsync(50);
      FakeServer.last.drop();
      expect(connection.topics.size).toBe(0);
      await vi.advanceTimersByTimeAsync(600);
    }
    expect(received).toEqual(["first", "second"]);
  });

  it("end while the page is hidden, except those of which every message counts", async () => {
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING, { ...STRING, id: 2, topic: "/rosout" });
    connection.subscribe("/chatter", {}, () => undefined);
    connection.subscribe("/rosout", { every: true }, () => undefined);
    const hide = (isHidden: boolean): void => {
      Object.defineProperty(document, "hidden", { value: isHidden, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    };
    hide(true);
    await vi.advanceTimersByTimeAsync(6000);
    expect(FakeServer.last.operations("unsubscribe")).toHaveLength(1);
    hide(false);
    expect(FakeServer.last.operations("subscribe")).toHaveLength(3);
  });

  it("keep a bounded number of messages while nothing is drawn", () => {
    FakeServer.last.welcome();
    FakeServer.last.advertise(STRING);
    let received = 0;
    connection.subscribe("/chatter", { every: true }, () => (received += 1));
    for (let index = 0; index < 10_000; index += 1) FakeServer.last.message(subscribed(), 1n, text("x"));
    vi.advanceTimersByTime(100);
    expect(received).toBe(2000);
  });
});

describe("requests", () => {
  it("publishes in CDR what the page knows, in JSON what only the server knows", () => {
    FakeServer.last.welcome();
    expect(connection.publish("/cmd_vel_teleop", "geometry_msgs/msg/Twist", { linear: { x: 0.5, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0 } })).toBe(true);
    expect(connection.publish("/own", "own_msgs/msg/Own", { a: 1n })).toBe(true);
    const [first, second] = FakeServer.last.operations("advertise").map((each) => (each["channels"] as Record<string, unknown>[])[0]!);
    expect(first).toMatchObject({ topic: "/cmd_vel_teleop", encoding: "cdr" });
    expect(second).toMatchObject({ topic: "/own", encoding: "json" });
    const frames = FakeServer.last.sent.filter((each) => each instanceof Uint8Array);
    expect(frames[0]!.length).toBe(5 + 4 + 48);
    expect(new TextDecoder().decode(frames[1]!.subarray(5))).toBe('{"a":1}');
  });

  it("publishes nothing without a connection", () => {
    expect(connection.publish("/cmd_vel", "geometry_msgs/msg/Twist", {})).toBe(false);
  });

  it("calls a service and decodes its response", async () => {
    FakeServer.last.welcome();
    const request = { encoding: "cdr", schemaName: "", schemaEncoding: "ros2msg", schema: "int64 a\nint64 b" };
    const response = { ...request, schema: "int64 sum" };
    FakeServer.last.text({ op: "advertiseServices", services: [{ id: 4, name: "/add", type: "example_interfaces/srv/AddTwoInts", request, response }] });
    const sum = connection.callService<{ sum: bigint }>("/add", { a: 2n, b: 3n });
    await vi.advanceTimersByTimeAsync(1);
    const call = FakeServer.last.sent.find((each) => each instanceof Uint8Array)!;
    const view = new DataView(call.buffer, call.byteOffset);
    expect([view.getUint8(0), view.getUint32(1, true)]).toEqual([2, 4]);
    const payload = encoderOf("int64 sum").encode({ sum: 5n });
    const frame = new Uint8Array(16 + payload.length);
    const head = new DataView(frame.buffer);
    head.setUint8(0, 3);
    head.setUint32(1, 4, true);
    head.setUint32(5, view.getUint32(5, true), true);
    head.setUint32(9, 3, true);
    frame.set(new TextEncoder().encode("cdr"), 13);
    frame.set(payload, 16);
    FakeServer.last.binary(frame.buffer);
    expect(await sum).toEqual({ sum: 5n });
    await expect(connection.callService("/none", {})).rejects.toThrow("no service /none");
  });

  it("rejects a refused parameter with the node's reason", async () => {
    FakeServer.last.welcome();
    const value = (speed: number): Record<string, unknown> => ({ op: "parameterValues", parameters: [{ name: "/control.speed", value: speed, type: "float64" }] });
    FakeServer.last.text(value(1));
    expect(connection.parameters.get("/control.speed")).toMatchObject({ node: "/control", value: 1, isWhole: false });
    const refused = connection.setParameter("/control.speed", 9);
    const accepted = expect(refused).rejects.toThrow("9 is not allowed");
    const [first] = FakeServer.last.operations("setParameters");
    expect(first!["parameters"]).toEqual([{ name: "/control.speed", value: 9, type: "float64" }]);
    FakeServer.last.text({ op: "status", level: 2, message: "parameter '/control.speed': 9 is not allowed" });
    FakeServer.last.text({ ...value(1), id: first!["id"] });
    await accepted;
    const set = connection.setParameter("/control.speed", 2);
    FakeServer.last.text({ ...value(2), id: FakeServer.last.operations("setParameters")[1]!["id"] });
    await set;
    expect(connection.parameters.get("/control.speed")?.value).toBe(2);
  });

  it("rejects what waits when the connection is lost", async () => {
    FakeServer.last.welcome();
    const waiting = [connection.fetchAsset("package://a/b"), connection.setParameter("/a.b", 1)].map((each) => expect(each).rejects.toThrow("not connected"));
    await vi.advanceTimersByTimeAsync(1);
    FakeServer.last.drop();
    await Promise.all(waiting);
  });
});

describe("time", () => {
  it("measures the speed and reports time that goes back", async () => {
    FakeServer.last.welcome();
    let resets = 0;
    connection.on("reset", () => (resets += 1));
    for (let step = 0; step <= 20; step += 1) {
      FakeServer.last.time(BigInt(step) * 200_000_000n);
      await vi.advanceTimersByTimeAsync(100);
    }
    expect(connection.nowNs).toBe(4_000_000_000n);
    expect(connection.speed).toBeCloseTo(2, 1);
    expect(resets).toBe(0);
    FakeServer.last.time(1_000_000_000n);
    expect(resets).toBe(1);
  });

  it("reads the state of a recording and controls it", () => {
    FakeServer.last.welcome({ capabilities: ["playbackControl"], dataStartTime: { sec: 10, nsec: 0 }, dataEndTime: { sec: 70, nsec: 5 } });
    expect(connection.playback).toEqual({ status: "paused", beginNs: 10_000_000_000n, endNs: 70_000_000_005n, speed: 1 });
    connection.controlPlayback({ play: true, speed: 2, seekNs: 20_000_000_000n });
    const frame = FakeServer.last.sent.at(-1) as Uint8Array;
    const view = new DataView(frame.buffer, frame.byteOffset);
    expect([view.getUint8(0), view.getUint8(1), view.getFloat32(2, true), view.getUint8(6), view.getBigUint64(7, true)]).toEqual([3, 0, 2, 1, 20_000_000_000n]);
    const state = new DataView(new ArrayBuffer(19));
    state.setUint8(0, 5);
    state.setBigUint64(2, 20_000_000_000n, true);
    state.setFloat32(10, 2, true);
    FakeServer.last.binary(state.buffer);
    expect(connection.playback).toMatchObject({ status: "playing", speed: 2 });
    expect(connection.nowNs).toBe(20_000_000_000n);
  });
});
