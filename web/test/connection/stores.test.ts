import { describe, expect, it } from "vitest";
import { decoderOf, encoderOf, knownDefinition } from "../../src/connection/codec";
import { KNOWN_DEFINITIONS } from "../../src/connection/known_definitions";
import { ParameterStore } from "../../src/connection/parameter_store";
import { Meter } from "../../src/connection/statistics";
import { TopicStore } from "../../src/connection/topic_store";

describe("codec", () => {
  it("encodes every type that the page publishes", () => {
    for (const [type, definition] of Object.entries(KNOWN_DEFINITIONS)) {
      const bytes = encoderOf(definition).encode({});
      expect(decoderOf(definition).decode(bytes), type).toBeTypeOf("object");
      expect(knownDefinition(type)).toBe(definition);
    }
  });

  it("encodes a type of constants only as nothing", () => {
    expect([...encoderOf("uint8 A=1\n# text\n").encode({})]).toEqual([0, 1, 0, 0, 0]);
  });

  it("decodes what it encoded", () => {
    const definition = "float64[] values\nstring name\nbool on";
    const message = { values: new Float64Array([1.5, -2]), name: "a", on: true };
    expect(decoderOf(definition).decode(encoderOf(definition).encode(message))).toEqual(message);
  });
});

describe("TopicStore", () => {
  const channel = { id: 1, topic: "/map", encoding: "cdr", schemaName: "nav_msgs/msg/OccupancyGrid", schema: "int8[] data" };
  const graph = { op: "connectionGraphUpdate" as const, publishedTopics: [], subscribedTopics: [], advertisedServices: [], removedTopics: [], removedServices: [] };

  it("merges channels with the graph, without the live view's own node", () => {
    const store = new TopicStore();
    store.advertise([channel]);
    expect(store.topics.get("/map")).toMatchObject({ isPublished: true, publishers: [] });
    store.update({ ...graph, publishedTopics: [{ name: "/map", publisherIds: ["/map_memory"] }], subscribedTopics: [{ name: "/goal", subscriberIds: ["/planner", "/viewer"] }] });
    expect(store.topics.get("/map")).toMatchObject({ isPublished: true, publishers: ["/map_memory"] });
    expect(store.topics.get("/goal")).toMatchObject({ isPublished: false, type: "", subscribers: ["/planner"] });
    store.update({ ...graph, removedTopics: ["/goal"], publishedTopics: [{ name: "/map", publisherIds: [] }] });
    expect([...store.topics.values()].map(({ name, isPublished }) => [name, isPublished])).toEqual([["/map", false]]);
    store.unadvertise([1]);
    expect(store.channelsOf("/map")).toEqual([]);
  });
});

describe("ParameterStore", () => {
  it("merges values with descriptions and reports what changed", () => {
    const store = new ParameterStore();
    expect(store.take([{ name: "/a.speed_mps", value: 1 }])).toEqual(["/a.speed_mps"]);
    expect(store.take([{ name: "/a.speed_mps", value: 1 }])).toEqual([]);
    const text = { name: "/a.speed_mps", meaning: "speed [m/s]", allowed: "", read_only: false, low: 0, high: 2, step: 0.5 };
    expect(store.describe([text, { ...text, name: "/b.other" }])).toEqual(["/a.speed_mps"]);
    expect(store.infos.get("/a.speed_mps")).toMatchObject({ low: 0, high: 2, step: 0.5, isWhole: true });
    expect(store.take([{ name: "/a.speed_mps", value: undefined }])).toEqual(["/a.speed_mps"]);
    expect(store.infos.size).toBe(0);
  });

  it("decodes bytes", () => {
    const store = new ParameterStore();
    store.take([{ name: "/a.key", value: btoa("\x01\xff"), type: "byte_array" }]);
    expect(store.infos.get("/a.key")?.value).toEqual(new Uint8Array([1, 255]));
  });

  it("does not take another parameter's refusal", () => {
    const store = new ParameterStore();
    const { done } = store.change("/a.b", 1);
    done.catch(() => undefined);
    expect(store.refuse("parameter '/a.c': no")).toBe(false);
    expect(store.refuse("something else about /a.b")).toBe(false);
    expect(store.refuse("parameter '/a.b': no")).toBe(true);
    store.clear();
  });
});

describe("Meter", () => {
  it("measures rate and bandwidth in the robot's time", () => {
    const meter = new Meter();
    for (let index = 0; index < 2000; index += 1) meter.add(BigInt(index) * 20_000_000n, 100);
    const { rateHz, bytesPerS, count } = meter.read(40_000_000_000n);
    expect(rateHz).toBeCloseTo(50, 0);
    expect(bytesPerS).toBeCloseTo(5000, -2);
    expect(count).toBe(2000);
  });

  it("counts down when a topic stops", () => {
    const meter = new Meter();
    for (let index = 0; index < 50; index += 1) meter.add(BigInt(index) * 100_000_000n, 10);
    expect(meter.read(5_000_000_000n).rateHz).toBeCloseTo(10, 0);
    expect(meter.read(9_900_000_000n).rateHz).toBeLessThan(6);
    expect(meter.read(60_000_000_000n)).toMatchObject({ rateHz: 0, bytesPerS: 0 });
  });

  it("knows no rate of one message and begins anew when time goes back", () => {
    const meter = new Meter();
    meter.add(5_000_000_000n, 10);
    expect(meter.read(5_000_000_000n).rateHz).toBeNull();
    meter.add(1_000_000_000n, 10);
    expect(meter.read(1_000_000_000n).rateHz).toBeNull();
  });
});
