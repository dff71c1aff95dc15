/** Layout of the node graph: layers along the flow of messages, few crossings. */

import type { Topic } from "../connection/connection";

export interface GraphEdge {
  readonly from: string;
  readonly to: string;
  readonly topics: readonly string[];
}

export interface GraphLayout {
  /** Node → its column and its row in it. */
  readonly places: ReadonlyMap<string, { readonly column: number; readonly row: number }>;
  readonly columns: number;
  readonly rows: number;
}

/** Topics that nearly all nodes share: they hide the others. */
export const COMMON = new Set(["/rosout", "/parameter_events", "/clock", "/tf", "/tf_static"]);

export function edgesOf(topics: Iterable<Topic>, includesCommon: boolean): GraphEdge[] {
  const found = new Map<string, { from: string; to: string; topics: string[] }>();
  for (const { name, publishers, subscribers } of topics) {
    if ((!includesCommon && COMMON.has(name)) || name.includes("/_action/")) continue;
    for (const from of publishers) {
      for (const to of subscribers) {
        if (from === to) continue;
        const key = `${from} ${to}`;
        const edge = found.get(key);
        if (edge) edge.topics.push(name);
        else found.set(key, { from, to, topics: [name] });
      }
    }
  }
  return [...found.values()];
}

/**
 * Layers by the longest path over edges that close no cycle, then the barycentre method
 * (Sugiyama et al. 1981): each node moves to the mean row of its neighbours, a few times.
 */
export function layOut(nodes: readonly string[], edges: readonly GraphEdge[]): GraphLayout {
  const forward = withoutCycles(nodes, edges);
  const column = new Map(nodes.map((node) => [node, 0]));
  for (let round = 0; round < nodes.length; round += 1) {
    let isChanged = false;
    for (const { from, to } of forward) {
      if (column.get(to)! <= column.get(from)!) {
        column.set(to, column.get(from)! + 1);
        isChanged = true;
      }
    }
    if (!isChanged) break;
  }
  const layers: string[][] = [];
  for (const node of nodes) (layers[column.get(node)!] ??= []).push(node);
  const neighbours = new Map<string, string[]>(nodes.map((node) => [node, []]));
  for (const { from, to } of edges) {
    neighbours.get(from)?.push(to);
    neighbours.get(to)?.push(from);
  }
  const height = Math.max(1, ...layers.map((layer) => layer.length));
  const row = new Map<string, number>();
  const place = (layer: string[]): void => layer.forEach((node, index) => row.set(node, index + (height - layer.length) / 2));
  layers.forEach(place);
  for (let sweep = 0; sweep < 6; sweep += 1) {
    for (const layer of sweep % 2 === 0 ? layers : [...layers].reverse()) {
      const centre = new Map(layer.map((node) => {
        const rows = neighbours.get(node)!.map((other) => row.get(other)!);
        return [node, rows.length > 0 ? rows.reduce((sum, each) => sum + each, 0) / rows.length : row.get(node)!];
      }));
      layer.sort((a, b) => centre.get(a)! - centre.get(b)! || a.localeCompare(b));
      place(layer);
    }
  }
  const places = new Map(nodes.map((node) => [node, { column: column.get(node)!, row: row.get(node)! }]));
  return { places, columns: layers.length, rows: height };
}

/** Edges except the back edges of a depth-first search from the sources. */
function withoutCycles(nodes: readonly string[], edges: readonly GraphEdge[]): GraphEdge[] {
  const outgoing = new Map<string, GraphEdge[]>(nodes.map((node) => [node, []]));
  const incoming = new Map(nodes.map((node) => [node, 0]));
  for (const edge of edges) {
    outgoing.get(edge.from)?.push(edge);
    incoming.set(edge.to, (incoming.get(edge.to) ?? 0) + 1);
  }
  const state = new Map<string, "open" | "done">();
  const kept: GraphEdge[] = [];
  const visit = (node: string): void => {
    state.set(node, "open");
    for (const edge of outgoing.get(node) ?? []) {
      if (state.get(edge.to) === "open" || !outgoing.has(edge.to)) continue;
      kept.push(edge);
      if (!state.has(edge.to)) visit(edge.to);
    }
    state.set(node, "done");
  };
  // Sensors first: the node with the fewest inputs and the most outputs begins.
  const order = [...nodes].sort((a, b) => incoming.get(a)! - outgoing.get(a)!.length - (incoming.get(b)! - outgoing.get(b)!.length) || a.localeCompare(b));
  for (const node of order) if (!state.has(node)) visit(node);
  return kept;
}
