/** The top bar: what the robot does, its facts, the state of the connection. */

import { commanderText, Duties, headlineOf, recordingText } from "../robot/headline";
import type { RobotState } from "../robot/robot_state";
import { clockText, fixed, speedText } from "../robot/text";
import { h, setText, svg } from "../ui/dom";
import { every } from "../ui/frames";

/** As fast as text can be read. */
const RATE_HZ = 5;

export class Header {
  readonly element: HTMLElement;
  /** Buttons at its end. */
  readonly actions = h("div", { class: "actions" });
  readonly #headline = h("p", { id: "headline" }, "Connecting");
  readonly #detail = h("p", { id: "detail" }, "Preparing the live view…");
  readonly #link = h("div", { id: "link", role: "status" }, h("i"), h("span", {}, "Connecting"));
  readonly #facts = new Map<string, { box: HTMLElement; value: HTMLElement }>();
  readonly #duties = new Duties();

  constructor(private readonly robot: RobotState) {
    const facts = h("dl", { class: "facts" });
    for (const [id, name] of [["position", "Position"], ["heading", "Heading"], ["speed", "Speed"], ["goal", "Goal"], ["contacts", "Contacts"], ["commander", "Commander"], ["clock", "Robot time"]] as const) {
      const value = h("dd", { id }, "–");
      const box = h("div", { class: id }, h("dt", {}, name), value);
      this.#facts.set(id, { box, value });
      facts.append(box);
    }
    this.element = h(
      "header",
      { class: "top" },
      logo(),
      h("h1", { class: "visually-hidden" }, "Navette"),
      h("div", { id: "state", "aria-live": "polite" }, this.#headline, this.#detail),
      facts,
      this.#link,
      this.actions,
    );
    robot.connection.on("topics", () => this.#duties.note(robot.connection));
    robot.connection.on("status", () => this.#draw());
    every(RATE_HZ, () => this.#draw());
    this.#draw();
  }

  #draw(): void {
    const { robot } = this;
    const { connection } = robot;
    const { text, detail, isBad } = headlineOf(robot, this.#duties);
    setText(this.#headline, text);
    setText(this.#detail, detail);
    this.#headline.classList.toggle("bad", isBad);
    this.#detail.title = detail;
    const isMute = connection.silenceS > 2.5;
    const { state } = connection.status;
    document.body.classList.toggle("stale", state !== "live" || isMute); // everything shown is old
    document.body.classList.toggle("stopped", robot.isStopped);
    this.#link.className = state === "live" && isMute ? "connecting" : state;
    const word = { connecting: "Connecting", live: isMute ? "No response" : recordingText(connection) ? "Recording" : "Live", lost: "Reconnecting" };
    setText(this.#link.lastElementChild!, word[state]);
    if (state === "lost") this.#duties.clear();
    this.#drawFacts();
  }

  #drawFacts(): void {
    const { motion, goal, contacts, stages, connection } = this.robot;
    // Odometry may be in a frame that drifts; people read places of the map.
    const place = motion && this.robot.placeOfMotion();
    this.#fact("position", place && `${fixed(place.x, 2)}, ${fixed(place.y, 2)}`, "m");
    this.#fact("heading", place && fixed(place.yawDeg, 0), "°");
    this.#fact("speed", motion && fixed(motion.speedMps, 2), "m/s");
    this.#fact("goal", goal && `${fixed(goal.x, 1)}, ${fixed(goal.y, 1)}`, "m");
    this.#fact("contacts", contacts > 0 ? String(contacts) : null, "");
    const arbiter = stages.get("arbiter");
    this.#fact("commander", arbiter ? commanderText(arbiter) : null, "");
    this.#fact("clock", connection.nowNs > 0n ? clockText(connection.nowNs) : null, speedText(connection.speed));
    this.#facts.get("contacts")!.box.hidden = contacts === 0;
    this.#facts.get("commander")!.box.hidden = !arbiter;
  }

  #fact(id: string, text: string | null, unit: string): void {
    const { value } = this.#facts.get(id)!;
    const key = text === null ? "" : text + unit;
    if (value.dataset["key"] === key) return;
    value.dataset["key"] = key;
    if (text === null) value.replaceChildren("–");
    else value.replaceChildren(text, ...(unit ? [unit === "°" ? "" : " ", h("small", {}, unit)] : []));
    value.title = text ?? ""; // long names are cut
  }
}

function logo(): SVGElement {
  return svg(
    "svg",
    { viewBox: "0 0 32 32", class: "logo", "aria-hidden": "true" },
    svg("path", { d: "M1 16C8 8.5 24 8.5 31 16 24 23.5 8 23.5 1 16Z" }),
    svg("rect", { x: "10", y: "14.4", width: "12", height: "3.2", rx: "1.6" }),
  );
}
