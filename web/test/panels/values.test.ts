import { describe, expect, it } from "vitest";
import { treeLine } from "../../src/panels/behavior_tree_text";
import { numberAt, numericPaths, parsePath, pathText } from "../../src/panels/field_path";
import { bytesText, clockText, numberText, stampText } from "../../src/panels/format";
import { edgesOf, layOut } from "../../src/panels/graph_layout";
import { boxesOf, toRgba } from "../../src/panels/image_decoding";
import { choicesOf, parseValue, rangeOf, unitOf, valueText } from "../../src/panels/parameter_values";
import { csvOf, PlotSeries } from "../../src/panels/plot_series";
import { readReport } from "../../src/panels/report_page";
import { findRun } from "../../src/panels/run_services";

describe("field paths", () => {
  it.each(["/odom/filtered.twist.twist.linear.x", "/lidar.ranges[180]", "/a.b[-1].c[2]", "/odom.pose.pose.orientation.@yaw"])("%s", (text) => {
    expect(pathText(parsePath(text)!)).toBe(text);
  });

  it.each(["", "odom.x", "/odom", "/odom.", "/odom.x y", "/odom[x]", "/a..b"])("refuses %j", (text) => expect(parsePath(text)).toBeNull());

  it("reads numbers, booleans, times and derived values", () => {
    const half = Math.SQRT1_2;
    const message = { x: 1.5, on: true, big: 7n, stamp: { sec: 2, nanosec: 500_000_000 }, ranges: new Float32Array([1, 2, 3]), q: { x: 0, y: 0, z: half, w: half }, v: { x: 3, y: 4, z: 0 } };
    const at = (path: string): number | null => numberAt(message, parsePath(`/t.${path}`)!.steps);
    expect([at("x"), at("on"), at("big"), at("stamp"), at("ranges[-1]"), at("ranges.@length"), at("v.@norm")]).toEqual([1.5, 1, 7, 2.5, 3, 3, 5]);
    expect(at("q.@yaw")).toBeCloseTo(Math.PI / 2);
    expect([at("none.deeper"), at("ranges[9]"), at("v")]).toEqual([null, null, null]);
    expect(numericPaths("/t", message)).toContain("/t.q.@yaw");
    expect(numericPaths("/t", message)).toContain("/t.ranges[0]");
  });
});

describe("text", () => {
  it("prints numbers, sizes and times", () => {
    expect([numberText(-0.123456789), numberText(NaN), numberText(1e21)]).toEqual(["−0.123457", "NaN", "1e+21"]);
    expect([numberText(-0.0000418321234, 3), numberText(0.00012)]).toEqual(["−4.18e−5", "0.00012"]);
    expect([bytesText(999), bytesText(12_345), bytesText(150_000_000)]).toEqual(["999 B", "12.3 kB", "150 MB"]);
    expect([clockText(65.25), clockText(5, 4000)]).toEqual(["1:05.2", "0:00:05.0"]);
    expect(stampText(1_500_000_000n)).toBe("1.500");
  });
});

describe("parameters", () => {
  it("finds the unit in the description, else in the name", () => {
    expect([unitOf("speed", "fastest [m/s]"), unitOf("turn_radps2", ""), unitOf("timeout_s", ""), unitOf("names", "")]).toEqual(["m/s", "rad/s²", "s", ""]);
  });

  it("converts what is typed to the parameter's kind or states why not", () => {
    expect(parseValue("1,5", 0)).toBe(1.5);
    expect(parseValue("−2", 1)).toBe(-2);
    expect(parseValue("[1, 2]", [0])).toEqual([1, 2]);
    expect(parseValue("text", "a")).toBe("text");
    for (const [typed, current] of [["", 1], ["x", 1], ["Infinity", 1], ["{}", [1]], ["[", [1]]] as const) expect(parseValue(typed, [...[current]].flat()[0] === current ? current : [...(current as readonly number[])])).toBeInstanceOf(Error);
  });

  it("derives ranges, choices and texts", () => {
    const info = { name: "/a.b", node: "/a", value: 0.3, isWhole: false };
    expect(rangeOf(info)).toEqual({ low: 0, high: 0.6, step: 0.005 });
    expect(rangeOf({ ...info, value: 3, isWhole: true, low: 1, high: 9 })).toEqual({ low: 1, high: 9, step: 1 });
    expect(choicesOf("one of a, b")).toEqual(["a", "b"]);
    expect(valueText(0.1 + 0.2)).toBe("0.3");
  });
});

describe("plots", () => {
  it("keeps a bounded number of the newest samples", () => {
    const series = new PlotSeries();
    for (let index = 0; index < 100_000; index += 1) series.add(index, 2 * index);
    expect(series.length).toBeLessThanOrEqual(40_000);
    expect(series.lastValue).toBe(199_998);
    const [times, values] = series.since(99_990);
    expect([times.length, values[0]]).toEqual([10, 199_980]);
    series.add(5, 1);
    expect(series.length).toBe(1);
  });

  it("writes one row per time", () => {
    const [a, b] = [new PlotSeries(), new PlotSeries()];
    a.add(1, 10);
    a.add(2, 20);
    b.add(2, 7);
    expect(csvOf(["/a.x", '/b."y"'], [a, b])).toBe('time_s,"/a.x","/b.""y"""\n1.000000,10,\n2.000000,20,7\n');
  });
});

describe("images", () => {
  it("converts colours with padding between rows", () => {
    const out = new Uint8ClampedArray(8);
    toRgba({ width: 1, height: 2, encoding: "bgr8", is_bigendian: 0, step: 4, data: new Uint8Array([1, 2, 3, 0, 4, 5, 6, 0]) }, out);
    expect([...out]).toEqual([3, 2, 1, 255, 6, 5, 4, 255]);
  });

  it("shows near depth brighter and invalid depth black", () => {
    const data = new Uint8Array(new Float32Array([1, 3, NaN, 0]).buffer);
    const out = new Uint8ClampedArray(16);
    toRgba({ width: 4, height: 1, encoding: "32FC1", is_bigendian: 0, step: 16, data }, out);
    expect([out[0], out[4], out[8], out[12]]).toEqual([255, 20, 0, 0]);
  });

  it("names an unknown encoding and a truncated image", () => {
    const image = { width: 2, height: 2, encoding: "yuv422", is_bigendian: 0, step: 4, data: new Uint8Array(8) };
    expect(() => toRgba(image, new Uint8ClampedArray(16))).toThrow("yuv422");
    expect(() => toRgba({ ...image, encoding: "rgb8", data: new Uint8Array(3) }, new Uint8ClampedArray(16))).toThrow("3 bytes, expected 8");
  });

  it("reads detections of both generations of vision_msgs", () => {
    const results = [{ hypothesis: { class_id: "person", score: 0.91 } }];
    const bbox = { center: { position: { x: 5, y: 6 }, theta: 0 }, size_x: 2, size_y: 4 };
    expect(boxesOf({ detections: [{ results, bbox }] })).toEqual([{ x: 5, y: 6, width: 2, height: 4, angle: 0, label: "person 91 %" }]);
    expect(boxesOf({ results: [{ id: "cup", score: 0.5 }], bbox: { center: { x: 1, y: 2, theta: 0 }, size_x: 1, size_y: 1 } })[0]).toMatchObject({ x: 1, y: 2, label: "cup 50 %" });
  });
});

describe("graph", () => {
  const topic = (name: string, publishers: string[], subscribers: string[]) => ({ name, type: "", publishers, subscribers, isPublished: true });

  it("orders nodes along the flow, in spite of a cycle", () => {
    const edges = edgesOf([topic("/scan", ["/sim"], ["/costmap"]), topic("/map", ["/costmap"], ["/planner"]), topic("/cmd_vel", ["/planner"], ["/sim"]), topic("/tf", ["/sim"], ["/planner"])], false);
    expect(edges.map(({ from, to }) => `${from} ${to}`)).toEqual(["/sim /costmap", "/costmap /planner", "/planner /sim"]);
    const { places, columns } = layOut(["/costmap", "/planner", "/sim"], edges);
    expect(columns).toBe(3);
    expect(new Set([...places.values()].map(({ column }) => column)).size).toBe(3);
    expect(places.get("/planner")!.column - places.get("/costmap")!.column).toBe(1);
  });
});

describe("behaviour tree", () => {
  it("reads status, depth and kind", () => {
    expect(treeLine("    {o} Ladder [*] -- retry 1")).toEqual({ depth: 1, status: "running", name: "Ladder", note: "fallback · retry 1" });
    expect(treeLine("something else")).toBeNull();
  });
});

describe("run control", () => {
  it("finds a simulation by its service, whatever its name", () => {
    expect(findRun(new Map([["/gz/set_simulation_state", "simulation_interfaces/srv/SetSimulationState"]]))).toBe("/gz/");
    expect(findRun(new Map([["/a/set_simulation_state", "std_srvs/srv/SetBool"]]))).toBeNull();
  });
});

describe("reports", () => {
  it("contain nothing that runs or loads", () => {
    const page = `<!doctype html><title>BARN</title><style>body{color:red} .body{x:y} @media (max-width: 9rem){p{color:red}} @media (prefers-color-scheme: dark){p{color:blue}} a{background:url(http://x/y)}</style>
      <body onload="x()"><h1 onclick="x()" style="position:fixed;width:63%;background:url(http://x/z)">Score</h1><script>x()</script><img src="http://x/y.png"><a href="javascript:x()">a</a><svg><use href="http://x"/><path d="M0 0"/></svg></body>`;
    const { title, content, styles, setDark } = readReport(page);
    const holder = document.createElement("div");
    holder.append(content);
    expect(title).toBe("BARN");
    expect(holder.innerHTML).not.toMatch(/script|onclick|http|fixed|<use/);
    expect(holder.querySelector("h1")!.style.width).toBe("63%");
    expect(holder.querySelector("h1")!.textContent).toBe("Score");
    expect(holder.querySelector("path")!.getAttribute("d")).toBe("M0 0");
    expect([...styles.cssRules].map((rule) => rule.cssText).join(" ")).not.toContain("http");
    const dark = [...styles.cssRules].find((rule) => rule instanceof CSSMediaRule)!;
    for (const [is, media] of [[true, "all"], [false, "not all"]] as const) {
      setDark(is);
      expect(dark.media.mediaText).toBe(media);
    }
    expect([...styles.cssRules].some((rule) => rule instanceof CSSContainerRule)).toBe(true);
  });

  it("are refused when they are empty", () => {
    expect(() => readReport("")).toThrow("not a report");
  });
});
