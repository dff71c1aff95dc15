/** Icons of 16 × 16 units, drawn in the current colour. */

import { svg } from "./dom";

/** Path data; strokes of 1.5 with round ends. */
const PATHS: Record<string, string> = {
  topics: "M3 4h10M3 8h10M3 12h6",
  raw: "M6 3H4.5v4L3 8l1.5 1v4H6M10 3h1.5v4L13 8l-1.5 1v4H10",
  plot: "M2.5 2.5v11h11M5 10l2.5-3.5L9.5 9l3.5-4.5",
  image: "M2.5 3.5h11v9h-11zM2.5 11l3-3 2.5 2.5 2-2 3.5 3.5M10.5 6.2v.1",
  parameters: "M2.5 5h6M11.5 5h2M2.5 11h2M7.5 11h6M10 3.5v3M6 9.5v3",
  log: "M3 3.5h10v9H3zM5.5 6.5l1.5 1.5-1.5 1.5M8.5 10h2",
  graph: "M4 6.2a2 2 0 1 0 0-.1M8 12.2a2 2 0 1 0 0-.1M9.5 5.2a2 2 0 1 0 0-.1M7.5 5.5h2M6.5 7.5l2.3 3",
  tree: "M8 2.5v3M4 10.5v-2h8v2M8 5.5v3M6.5 2.5h3M2.5 10.5h3v3h-3zM10.5 10.5h3v3h-3z",
  diagnostics: "M2 8.5h3l1.5-4 3 7 1.5-3h3",
  run: "M5 3.5v9l7.5-4.5z",
  playback: "M3 8a5 5 0 1 0 1.5-3.5L3 6M3 3v3h3",
  frames: "M4 12V4M4 12h8M4 12l5-5M2.5 5.5 4 4l1.5 1.5M10.5 10.5 12 12l-1.5 1.5",
  displays: "M8 2.5 14 6 8 9.5 2 6zM2.5 9 8 12.3 13.5 9",
  report: "M4 2.5h5.5l3 3v8H4zM6.5 8h4M6.5 10.5h4M9.5 2.5v3h3",
  nodes: "M2.5 3h4.5v4H2.5zM9 3h4.5v4H9zM2.5 9h4.5v4H2.5zM9 9h4.5v4H9z",
  goal: "M8 14s4.5-4.2 4.5-7.5a4.5 4.5 0 0 0-9 0C3.5 9.8 8 14 8 14zM8 6.6v.1",
  pose: "M3 13 13 3M7.5 3H13v5.5",
  waypoints: "M4 12.2a1.3 1.3 0 1 0 0-.1M10.5 4.2a1.3 1.3 0 1 0 0-.1M5 11 11 5.2",
  estimate: "M8 2v3M8 11v3M2 8h3M11 8h3M8 4.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z",
  measure: "M2.5 11.5l9-9 2 2-9 9zM5 9l1 1M7 7l1 1M9 5l1 1",
  select: "M4 2.5 12 8l-3.7.8L6.5 12z",
  stick: "M8 2.5a5.5 5.5 0 1 0 0 11 5.5 5.5 0 0 0 0-11zM8 6.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
  follow: "M8 5.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5zM8 1.5v2M8 12.5v2M1.5 8h2M12.5 8h2",
  fit: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  cube: "M8 2 13.5 5v6L8 14 2.5 11V5zM2.5 5 8 8l5.5-3M8 8v6",
  plan: "M2.5 2.5h11v11h-11zM2.5 8h5M7.5 2.5v7M10.5 8h3",
  coordinates: "M6.5 2.5 5 13.5M11 2.5 9.5 13.5M2.5 6h11M2.5 10h11",
  close: "M4 4l8 8M12 4l-8 8",
  plus: "M8 3v10M3 8h10",
  menu: "M2.5 4.5h11M2.5 8h11M2.5 11.5h11",
  more: "M3.5 8h.1M8 8h.1M12.5 8h.1",
  pause: "M5.5 3.5v9M10.5 3.5v9",
  play: "M5 3.5v9l7.5-4.5z",
  step: "M4 3.5v9l6-4.5zM12.5 3.5v9",
  reset: "M13 8a5 5 0 1 1-1.5-3.5L13 6M13 3v3h-3",
  left: "M10 3 5 8l5 5",
  right: "M6 3l5 5-5 5",
  up: "M3 10l5-5 5 5",
  down: "M3 6l5 5 5-5",
  sun: "M8 5.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5zM8 1.5v1.5M8 13v1.5M1.5 8H3M13 8h1.5M3.4 3.4l1 1M11.6 11.6l1 1M3.4 12.6l1-1M11.6 4.4l1-1",
  moon: "M13 9.5A5.5 5.5 0 1 1 6.5 3 4.5 4.5 0 0 0 13 9.5z",
  eye: "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
  download: "M8 2.5v7.5M4.5 7 8 10.5 11.5 7M3 13.5h10",
  upload: "M8 10.5V3M4.5 6 8 2.5 11.5 6M3 13.5h10",
  copy: "M5.5 5.5h8v8h-8zM10.5 5.5v-3h-8v8h3",
  help: "M6 6a2 2 0 1 1 2.8 1.8c-.5.3-.8.7-.8 1.4M8 11.8v.1M8 1.8a6.2 6.2 0 1 0 0 12.4A6.2 6.2 0 0 0 8 1.8z",
  search: "M7 3a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM10 10l3.5 3.5",
  filter: "M2.5 3.5h11L9.5 8.5v4l-3-1.5V8.5z",
  check: "M3 8.5 6.5 12 13 4.5",
  warning: "M8 2.5 14.5 13.5h-13zM8 6.5v3.5M8 11.8v.1",
  phone: "M5 1.5h6v13H5zM7.5 12.5h1",
  layout: "M2.5 2.5h11v11h-11zM2.5 9.5h11M9.5 2.5v7",
};

export type IconName = string;

export function icon(name: IconName): SVGElement {
  const path = PATHS[name];
  if (path === undefined) throw new Error(`no icon ${name}`);
  return svg("svg", { viewBox: "0 0 16 16", class: "icon", "aria-hidden": "true" }, svg("path", { d: path }));
}
