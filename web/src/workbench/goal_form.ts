/** A goal by its coordinates: for exact places, and without a pointer. */

import type { Operator } from "../robot/operator";
import { parseNumber } from "../robot/text";
import type { Scene } from "../scene/scene";
import { h } from "../ui/dom";
import { popover, type Popover } from "./popover";

export function goalForm(scene: Scene, operator: Operator): Popover {
  const field = (id: string, label: string, hint: string): [HTMLElement, HTMLInputElement] => {
    const input = h("input", { id, inputmode: "decimal", autocomplete: "off", placeholder: hint });
    return [h("label", {}, label, input), input];
  };
  const [xRow, x] = field("x", "x in m", "0.0");
  const [yRow, y] = field("y", "y in m", "0.0");
  const [yawRow, yaw] = field("yaw", "Heading in °", "any");
  const problem = h("p", { class: "hint bad", hidden: true });

  const send = (close: () => void): void => {
    const [px, py] = [parseNumber(x.value), parseNumber(y.value)];
    const turn = yaw.value.trim() === "" ? null : (parseNumber(yaw.value) * Math.PI) / 180;
    const frame = scene.fixedFrame;
    const reason =
      !Number.isFinite(px) || !Number.isFinite(py) ? "x and y must be numbers, in metres."
      : turn !== null && !Number.isFinite(turn) ? "The heading must be a number of degrees, or empty."
      : frame === null ? "No map received yet." : "";
    problem.textContent = reason;
    problem.hidden = reason === "";
    if (reason || frame === null) return;
    operator.sendGoal({ frame, x: px, y: py, yaw: turn });
    close();
  };

  return popover("Goal by coordinates", "coordinates", (close) => [
    h(
      "form",
      { class: "goal-form", onsubmit: (event: SubmitEvent) => { event.preventDefault(); send(close); } },
      h("h2", {}, "Goal by coordinates"),
      xRow, yRow, yawRow, problem,
      h("button", { class: "main", id: "go" }, "Go"),
      h("p", { class: "hint" }, `In the frame ${scene.fixedFrame ?? "of the map"}.`),
    ),
  ]);
}
