/** The list of waypoints: planned ones with Start, or those on the way. */

import type { Operator } from "../robot/operator";
import type { Goal } from "../robot/robot_state";
import { fixed } from "../robot/text";
import type { ToolSet } from "../tools/tool_set";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";

export function waypointCard(tools: ToolSet, operator: Operator): HTMLElement {
  const tool = tools.waypoints;
  const list = h("ol", { class: "waypoints" });
  const start = h("button", { class: "main", onclick: () => tool.start() }, "Start");
  const clear = h("button", { onclick: () => tool.clear() }, "Clear");
  const hint = h("p", { class: "hint" });
  const card = h("section", { class: "waypoint-card", "aria-label": "Waypoints" }, h("h2", {}, "Waypoints"), hint, list, h("div", { class: "row" }, start, clear));
  let drawn = "";

  const row = ({ x, y }: Goal, index: number, isPlanned: boolean): HTMLElement =>
    h(
      "li",
      {},
      h("span", { class: "number grow" }, `${fixed(x, 1)}, ${fixed(y, 1)} m`),
      isPlanned && h("button", { class: "bare", "aria-label": `Remove waypoint ${index + 1}`, onclick: () => tool.remove(index) }, icon("close")),
    );

  const draw = (): void => {
    const onTheWay = operator.waypoints;
    const isPlanning = tools.chosen === tool;
    card.hidden = !isPlanning && onTheWay.length === 0;
    const shown = isPlanning ? tool.planned : onTheWay;
    const key = JSON.stringify([isPlanning, shown]);
    if (key === drawn) return;
    drawn = key;
    hint.textContent = isPlanning
      ? shown.length > 0 ? "" : "Click in the scene to add places."
      : "On the way; this page sends the next one on arrival.";
    hint.hidden = hint.textContent === "";
    list.replaceChildren(...shown.map((goal, index) => row(goal, index, isPlanning)));
    start.hidden = clear.hidden = !isPlanning || shown.length === 0;
  };
  tool.onChange = draw;
  tools.onChange(draw);
  operator.robot.onChange(draw);
  draw();
  return card;
}
