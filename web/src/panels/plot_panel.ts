/** Any numbers of any messages over time: the body of the plot panel, loaded with uPlot. */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import "./plot.css";
import type { Dispose } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { type FieldPath, numberAt, numericPaths, parsePath, pathText } from "./field_path";
import { download, numberText } from "./format";
import type { PanelContext, PanelInstance } from "./panel";
import { csvOf, PlotSeries } from "./plot_series";

const COLOURS = ["thread", "laser", "mark", "good", "sea", "wait", "bad", "trail"];
const SPANS_S = [10, 30, 60, 300, 1800];
const DRAW_HZ = 10;
const LEAST_SPAN = 1e-6;
/** What a filter leaves of zero is zero to a reader; files keep it. */
const LEAST_VALUE = 1e-12;

interface Curve {
  readonly path: FieldPath;
  readonly text: string;
  readonly samples: PlotSeries;
  readonly value: HTMLElement;
  isShown: boolean;
}

export class PlotPanel implements PanelInstance {
  readonly #curves: Curve[] = [];
  readonly #chart = h("div", { class: "plot-chart" });
  readonly #legend = h("ul", { class: "plot-legend" });
  readonly #empty = emptyState("plot", "Nothing to plot", "Add a number by its path, for example /odom/filtered.twist.twist.linear.x");
  readonly #path: HTMLInputElement;
  readonly #suggestions = h("datalist", { id: `plot-paths-${Math.random().toString(36).slice(2)}` });
  readonly #span: HTMLSelectElement;
  readonly #pause: HTMLButtonElement;
  readonly #live: HTMLButtonElement;
  readonly #subscriptions = new Map<string, Dispose>();
  /** Topics of which this panel has received a message. */
  readonly #received = new Set<string>();
  readonly #ends: Dispose[] = [];
  readonly #resize: ResizeObserver;
  #plot: uPlot | null = null;
  #isPaused = false;
  #isZoomed = false;
  #isVisible = false;
  #draw: Dispose | null = null;
  #suggested = "";

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    const { settings, connection } = context;
    this.#path = h("input", { type: "text", class: "grow plot-path", placeholder: "/topic.field", "aria-label": "Path of a number", list: this.#suggestions.id,
      spellcheck: "false", autocomplete: "off", oninput: () => this.#suggest(), onfocus: () => this.#suggest() });
    const form = h("form", { class: "plot-form", onsubmit: (event: Event) => {
      event.preventDefault();
      this.#submit();
    } }, this.#path, this.#suggestions, h("button", { type: "submit", title: "Add to the plot", "aria-label": "Add to the plot" }, icon("plus")));
    this.#span = h("select", { "aria-label": "Time span", onchange: () => {
      settings.set("spanS", Number(this.#span.value));
      this.#setZoomed(false);
    } });
    this.#span.append(...SPANS_S.map((span) => new Option(span < 60 ? `${span} s` : `${span / 60} min`, String(span))));
    this.#span.value = String(settings.get<number>("spanS", 30));
    this.#pause = h("button", { class: "bare", "aria-pressed": "false", title: "Pause", "aria-label": "Pause", onclick: () => this.#setPaused(!this.#isPaused) }, icon("pause"));
    this.#live = h("button", { hidden: true, title: "Back to the newest values", onclick: () => this.#setZoomed(false) }, "Live");
    const csv = h("button", { class: "bare plot-save", title: "Save as CSV", "aria-label": "Save as CSV", onclick: () => this.#saveCsv() }, icon("download"), "CSV");
    const png = h("button", { class: "bare plot-save", title: "Save as PNG", "aria-label": "Save as PNG", onclick: () => this.#savePng() }, icon("download"), "PNG");
    container.append(h("div", { class: "panel" }, h("div", { class: "bar" }, form, this.#span, this.#live, this.#pause, csv, png),
      h("div", { class: "body plot-body" }, this.#legend, this.#chart, this.#empty.element)));
    this.#resize = new ResizeObserver(() => this.#fit());
    this.#resize.observe(this.#chart);
    this.#ends.push(context.theme.onChange(() => this.#rebuild()));
    this.#ends.push(connection.on("reset", () => this.#curves.forEach(({ samples }) => samples.clear())));
    for (const text of settings.get<string[]>("paths", [])) this.#add(text);
    this.#changed();
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    this.#draw?.();
    this.#draw = isVisible ? every(DRAW_HZ, () => this.#show()) : null;
    this.#subscribe();
    if (isVisible) this.#fit();
  }

  dispose = (): void => {
    this.setVisible(false);
    this.#resize.disconnect();
    for (const end of this.#ends) end();
    this.#plot?.destroy();
  };

  #submit(): void {
    const text = this.#path.value;
    if (!this.#add(text)) {
      this.context.announce(`${text || "Nothing"} is not a path: expected /topic.field`, "error");
      return;
    }
    this.#path.value = "";
    this.#changed();
  }

  #add(text: string): boolean {
    const path = parsePath(text);
    if (!path) return false;
    const name = pathText(path);
    if (!this.#curves.some((curve) => curve.text === name)) {
      this.#curves.push({ path, text: name, samples: new PlotSeries(), value: h("span", { class: "number plot-value" }, "–"), isShown: true });
    }
    return true;
  }

  #remove(curve: Curve): void {
    this.#curves.splice(this.#curves.indexOf(curve), 1);
    this.#changed();
  }

  #changed(): void {
    this.context.settings.set("paths", this.#curves.map(({ text }) => text));
    this.context.setTitle(this.#curves.length === 0 ? "Plot" : `Plot: ${titleOf(this.#curves.map(({ path }) => path))}`);
    this.#empty.element.hidden = this.#curves.length > 0;
    this.#chart.hidden = this.#curves.length === 0;
    this.#legend.hidden = this.#curves.length === 0;
    this.#subscribe();
    this.#rebuild();
  }

  #subscribe(): void {
    const topics = new Set(this.#isVisible ? this.#curves.map(({ path }) => path.topic) : []);
    for (const [topic, end] of this.#subscriptions) {
      if (topics.has(topic)) continue;
      end();
      this.#subscriptions.delete(topic);
    }
    for (const topic of topics) {
      if (this.#subscriptions.has(topic)) continue;
      const end = this.context.connection.subscribe(topic, { every: true }, ({ value, stampNs }) => {
        if (this.#isPaused) return;
        this.#received.add(topic);
        for (const curve of this.#curves) {
          if (curve.path.topic !== topic) continue;
          const number = numberAt(value, curve.path.steps);
          if (number !== null) curve.samples.add(Number(stampNs) / 1e9, number);
        }
      });
      this.#subscriptions.set(topic, end);
    }
  }

  #colour(index: number): string {
    return this.context.theme.colour(COLOURS[index % COLOURS.length]!);
  }

  #rebuild(): void {
    this.#plot?.destroy();
    this.#plot = null;
    this.#isZoomed = false;
    this.#live.hidden = true;
    this.#legend.replaceChildren(...this.#curves.map((curve, index) => this.#legendItem(curve, index)));
    if (this.#curves.length === 0) return;
    const { theme } = this.context;
    const axis: uPlot.Axis = { stroke: theme.colour("quiet"), grid: { stroke: theme.colour("line"), width: 1 }, ticks: { stroke: theme.colour("line"), width: 1, size: 4 }, font: "11px system-ui", gap: 4 };
    const axisText = (_plot: uPlot, values: number[]): string[] => values.map((value) => numberText(value, 12));
    this.#plot = new uPlot({
      width: Math.max(this.#chart.clientWidth, 50),
      height: Math.max(this.#chart.clientHeight, 50),
      padding: [8, 8, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: true, y: false, setScale: true }, points: { size: 6 } },
      scales: { x: { time: false }, y: { range: (_plot, low, high) => paddedRange(low, high) } },
      axes: [{ ...axis, size: 26, values: axisText }, { ...axis, size: (_plot: uPlot, texts: string[] | null) => Math.max(44, 16 + 6.2 * Math.max(0, ...(texts ?? []).map((text) => text.length))), values: axisText }],
      series: [{}, ...this.#curves.map((curve, index) => ({ label: curve.text, stroke: this.#colour(index), width: 1.5, points: { show: false }, spanGaps: true, show: curve.isShown }))],
      hooks: {
        setSelect: [(plot) => { if (plot.select.width > 0) this.#setZoomed(true); }],
        setCursor: [() => this.#showValues()],
      },
    }, [[0], ...this.#curves.map(() => [null])] as uPlot.AlignedData, this.#chart);
    this.#plot.over.addEventListener("dblclick", () => this.#setZoomed(false));
    this.#show();
  }

  #legendItem(curve: Curve, index: number): HTMLElement {
    const swatch = h("span", { class: "plot-swatch" });
    swatch.style.background = this.#colour(index);
    const name = h("button", { class: "bare plot-name", "aria-pressed": String(curve.isShown), title: "Show or hide", onclick: () => {
      curve.isShown = !curve.isShown;
      name.setAttribute("aria-pressed", String(curve.isShown));
      this.#plot?.setSeries(index + 1, { show: curve.isShown });
    } }, swatch, curve.text);
    const remove = h("button", { class: "bare", title: "Remove", "aria-label": `Remove ${curve.text}`, onclick: () => this.#remove(curve) }, icon("close"));
    return h("li", {}, name, curve.value, remove);
  }

  #show(): void {
    if (!this.#plot || !this.#isVisible) return;
    if (!this.#isZoomed && !this.#isPaused) {
      const last = Math.max(...this.#curves.map(({ samples }) => samples.lastTime ?? -Infinity));
      if (!Number.isFinite(last)) return;
      const first = Math.min(...this.#curves.map(({ samples }) => samples.firstTime ?? Infinity));
      const begin = Math.max(last - Number(this.#span.value), Math.min(first, last - 1));
      const tables = this.#curves.map(({ samples }) => samples.since(begin) as unknown as uPlot.AlignedData);
      const data = tables.length > 1 ? uPlot.join(tables) : tables[0]!;
      this.#plot.setData(data, false);
      this.#plot.setScale("x", { min: begin, max: last });
    }
    this.#showValues();
  }

  #showValues(): void {
    const index = this.#plot?.cursor.idx;
    this.#curves.forEach((curve, column) => {
      const at = index === null || index === undefined ? curve.samples.lastValue : this.#plot!.data[column + 1]![index];
      setText(curve.value, typeof at === "number" ? numberText(Math.abs(at) < LEAST_VALUE ? 0 : at, 5) : curve.samples.length === 0 ? this.#whyEmpty(curve) : "–");
    });
  }

  #whyEmpty({ path }: Curve): string {
    if (!this.context.connection.topics.get(path.topic)?.isPublished) return "not published";
    return this.#received.has(path.topic) ? "no such number" : "no message yet";
  }

  #setPaused(isPaused: boolean): void {
    this.#isPaused = isPaused;
    this.#pause.setAttribute("aria-pressed", String(isPaused));
    this.#pause.replaceChildren(icon(isPaused ? "play" : "pause"));
    this.#pause.title = isPaused ? "Continue" : "Pause";
    this.#pause.setAttribute("aria-label", this.#pause.title);
  }

  #setZoomed(isZoomed: boolean): void {
    this.#isZoomed = isZoomed;
    this.#live.hidden = !isZoomed;
    if (!isZoomed) this.#show();
  }

  #fit(): void {
    const { clientWidth: width, clientHeight: height } = this.#chart;
    if (this.#plot && width > 0 && height > 0) this.#plot.setSize({ width, height });
  }

  /** Suggest topics, and the numbers of a topic's message once its name is there. */
  #suggest(): void {
    const { connection } = this.context;
    const typed = this.#path.value;
    const topic = /^(\/[^.[]*)[.[]/.exec(typed)?.[1] ?? (connection.topics.has(typed) ? typed : "");
    if (topic && topic !== this.#suggested && connection.topics.get(topic)?.isPublished) {
      this.#suggested = topic;
      const end = connection.subscribe(topic, { rateHz: 1 }, ({ value }) => {
        end();
        this.#offer(numericPaths(topic, value));
      });
      setTimeout(end, 3000);
    } else if (!topic) {
      this.#suggested = "";
      this.#offer([...connection.topics.values()].filter(({ isPublished, name }) => isPublished && !name.includes("/_")).map(({ name }) => `${name}.`));
    }
  }

  #offer(values: readonly string[]): void {
    this.#suggestions.replaceChildren(...values.map((value) => h("option", { value })));
  }

  #saveCsv(): void {
    download("navette-plot.csv", csvOf(this.#curves.map(({ text }) => text), this.#curves.map(({ samples }) => samples)), "text/csv");
    this.context.announce("Plot saved as CSV");
  }

  #savePng(): void {
    const chart = this.#plot?.ctx.canvas;
    if (!chart) return;
    const scale = devicePixelRatio;
    const line = 18 * scale;
    const canvas = h("canvas", { width: chart.width, height: chart.height + line * (this.#curves.length + 0.5) });
    const context = canvas.getContext("2d")!;
    context.fillStyle = this.context.theme.colour("card");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.font = `${12 * scale}px system-ui`;
    this.#curves.forEach(({ text }, index) => {
      context.fillStyle = this.#colour(index);
      context.fillText(text, 12 * scale, line * (index + 1));
    });
    context.drawImage(chart, 0, line * (this.#curves.length + 0.5));
    canvas.toBlob((blob) => blob && download("navette-plot.png", blob, "image/png"));
    this.context.announce("Plot saved as PNG");
  }
}

/** The field of one number, the topics of several. */
function titleOf(paths: readonly FieldPath[]): string {
  if (paths.length === 1) return paths[0]!.steps.slice(-2).join(".");
  return [...new Set(paths.map(({ topic }) => topic.slice(1)))].join(", ");
}

function paddedRange(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  // Rounding noise is not magnified to the height of the panel.
  const least = Math.max(LEAST_SPAN, 1e-6 * Math.abs(high));
  const margin = high - low > least ? 0.08 * (high - low) : Math.max(Math.abs(high) * 0.1, 0.1);
  return [low - margin, high + margin];
}
