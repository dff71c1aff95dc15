/** The scene with what lies on it: tools, view, scale, coordinates, results, stop. */

import { fixed } from "../robot/text";
import type { Operator } from "../robot/operator";
import type { Scene } from "../scene/scene";
import { makeStick } from "../tools/teleop";
import type { ToolSet } from "../tools/tool_set";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";
import { goalForm } from "./goal_form";
import { InfoCard } from "./info_card";
import { waypointCard } from "./waypoint_card";

const ANSWER_MS = 8000;
/** So long after the connection the first messages may take. */
const FIRST_MS = 5000;

export class SceneView {
  readonly element: HTMLElement;
  readonly #answer = h("p", { id: "answer", role: "status" });
  readonly #help = h("p", { id: "help", class: "help" });
  readonly #cursor = h("span", { id: "cursor", class: "number" });
  readonly #scale = h("div", { class: "scale" }, h("i"), h("span", { class: "number" }));
  readonly #frame = h("select", { "aria-label": "Fixed frame", id: "frame" });
  readonly #buttons = new Map<string, HTMLButtonElement>();
  readonly #welcome = h("div", { class: "welcome" });
  readonly #stop = h("button", { id: "stop", title: "Emergency stop (Space)" }, "Stop");
  readonly #release = h("button", { id: "release", hidden: true }, "Release the stop");
  readonly #cancel = h("button", { id: "cancel", title: "Cancel the goal (C)" }, icon("close"), "Cancel");
  readonly #pause = h("button", { id: "pause", title: "Pause navigation (P)", "aria-pressed": "false" }, icon("pause"), "Pause");
  readonly #drive = h("button", { id: "drive", title: "Drive with a stick (D)", "aria-pressed": "false" }, icon("stick"), "Drive");
  readonly #stick: HTMLElement;
  #answerTimer: ReturnType<typeof setTimeout> | undefined;
  /** Since when the connection is live. */
  #connectedMs = performance.now();

  constructor(
    private readonly scene: Scene,
    private readonly tools: ToolSet,
    private readonly operator: Operator,
  ) {
    this.#stick = makeStick(operator);
    this.#stick.hidden = true;
    const [toolBar, viewBar] = [this.#toolBar(), this.#viewBar()];
    const operate = h("div", { id: "operate" }, this.#stick, h("div", { class: "row" }, this.#drive, this.#pause, this.#cancel), h("div", { class: "row" }, this.#release, this.#stop));
    this.element = h(
      "main",
      { class: "scene", "aria-label": "Scene" },
      scene.element,
      toolBar,
      viewBar,
      this.#welcome,
      waypointCard(tools, operator),
      h("div", { class: "foot" }, this.#scale, this.#cursor, this.#help),
      this.#answer,
      operate,
    );
    const info = new InfoCard(scene, operator, this.element, operate);
    const bars = new ResizeObserver(() => {
      scene.covered = { coveredLeft: toolBar.offsetLeft + toolBar.offsetWidth, coveredTop: viewBar.offsetTop + viewBar.offsetHeight };
    });
    [toolBar, viewBar].forEach((bar) => bars.observe(bar));
    tools.inspect.onInspect = (px, py) => info.show(px, py);
    this.#wire();
    tools.onChange(() => this.#drawTools());
    scene.onChange(() => this.#drawView());
    every(6, () => this.#draw());
    this.#drawTools();
    this.#drawView();
  }

  answer(text: string, isBad = false): void {
    setText(this.#answer, text);
    this.#answer.classList.toggle("bad", isBad);
    clearTimeout(this.#answerTimer);
    this.#answerTimer = setTimeout(() => setText(this.#answer, ""), ANSWER_MS);
  }

  toggleStick(): void {
    this.#stick.hidden = !this.#stick.hidden;
    this.#drive.setAttribute("aria-pressed", String(!this.#stick.hidden));
  }

  async toggleThreeDimensional(): Promise<void> {
    try {
      await this.scene.setThreeDimensional(!this.scene.isThreeDimensional);
    } catch {
      this.answer("3D is not available: this browser has no WebGL.", true);
    }
  }

  togglePause(): void {
    this.operator.pause(!this.operator.isPaused);
  }

  #wire(): void {
    const { operator } = this;
    this.#stop.addEventListener("click", () => operator.stop());
    this.#release.addEventListener("click", () => operator.release());
    this.#cancel.addEventListener("click", () => operator.cancel());
    this.#pause.addEventListener("click", () => this.togglePause());
    this.#drive.addEventListener("click", () => this.toggleStick());
    this.#frame.addEventListener("change", () => this.scene.chooseFrame(this.#frame.value || null));
  }

  #toolBar(): HTMLElement {
    const bar = h("div", { class: "tool-bar card-bar", role: "toolbar", "aria-label": "Tools", "aria-orientation": "vertical" });
    for (const tool of this.tools.all) {
      const label = `${tool.title} (${tool.key.toUpperCase()})`;
      const button = h("button", { class: "bare", "aria-label": tool.title, title: label, "aria-pressed": "false", onclick: () => this.tools.choose(tool) }, icon(tool.icon));
      this.#buttons.set(tool.id, button);
      bar.append(button);
    }
    const form = goalForm(this.scene, this.operator);
    bar.append(form.button, form.card);
    return bar;
  }

  #viewBar(): HTMLElement {
    const { scene } = this;
    const button = (id: string, text: string, iconName: string, title: string, act: () => void): HTMLButtonElement => {
      const made = h("button", { id, title, onclick: act }, icon(iconName), text);
      this.#buttons.set(id, made);
      return made;
    };
    return h(
      "div",
      { class: "view-bar", role: "toolbar", "aria-label": "View" },
      h("label", { class: "frame" }, icon("frames"), this.#frame),
      button("follow", "Follow", "follow", "Keep the robot in the middle (F)", () => scene.viewing.setMode(scene.viewing.mode === "follow" ? "free" : "follow")),
      button("fit", "Fit", "fit", "Show everything that is known (A)", () => scene.viewing.setMode(scene.viewing.mode === "fit" ? "free" : "fit")),
      button("three", "3D", "cube", "Show in 3D (3)", () => void this.toggleThreeDimensional()),
    );
  }

  #drawTools(): void {
    const { chosen, all, pointer } = this.tools;
    for (const tool of all) this.#buttons.get(tool.id)?.setAttribute("aria-pressed", String(tool === chosen));
    this.scene.element.dataset["tool"] = chosen.id;
    setText(this.#cursor, pointer ? `${fixed(pointer[0], 2)}, ${fixed(pointer[1], 2)} m` : "");
  }

  #drawView(): void {
    const { scene } = this;
    this.#buttons.get("follow")?.setAttribute("aria-pressed", String(scene.viewing.mode === "follow"));
    this.#buttons.get("fit")?.setAttribute("aria-pressed", String(scene.viewing.mode === "fit"));
    this.#buttons.get("three")?.setAttribute("aria-pressed", String(scene.isThreeDimensional));
    const frames = scene.transforms.frames;
    const shown = scene.chosenFrame;
    const names = shown !== null && !frames.includes(shown) ? [...frames, shown] : frames;
    const key = `${names.join("\n")}|${scene.fixedFrame ?? ""}`;
    if (this.#frame.dataset["key"] === key) return;
    this.#frame.dataset["key"] = key;
    this.#frame.replaceChildren(new Option(`auto: ${scene.fixedFrame ?? "none yet"}`, ""), ...names.map((name) => new Option(name, name)));
    this.#frame.value = shown ?? "";
  }

  #draw(): void {
    const { scene, operator, tools } = this;
    const { robot } = operator;
    this.#drawScale();
    this.#drawView();
    const drives = robot.driveTopic !== undefined;
    const { chosen } = tools;
    const keys = robot.isStopped ? "Release the stop to drive." : drives ? "Arrow keys drive, Space stops." : "";
    const help = [chosen.obstacle || chosen.hint, keys].filter(Boolean).join(" ");
    setText(this.#help, help);
    scene.canvas.ariaLabel = `Map. ${help}`;
    for (const tool of tools.all) {
      const button = this.#buttons.get(tool.id);
      if (!button) continue;
      button.classList.toggle("unavailable", tool.obstacle !== "");
      button.title = `${tool.title} (${tool.key.toUpperCase()})${tool.obstacle ? `: ${tool.obstacle}` : ""}`;
    }
    this.element.classList.toggle("recording", robot.connection.playback !== null && !drives);
    this.#release.hidden = !robot.isStopped;
    setText(this.#stop, robot.isStopped ? "Stopped" : "Stop");
    this.#cancel.disabled = !robot.isSubscribed("/cancel_goal");
    this.#pause.hidden = !robot.isSubscribed("/pause_navigation");
    this.#pause.setAttribute("aria-pressed", String(operator.isPaused));
    this.#drive.disabled = !drives;
    if (!drives && !this.#stick.hidden) this.toggleStick();
    this.#drawWelcome();
  }

  /** A round number of metres, between 60 and 150 pixels long. */
  #drawScale(): void {
    const { scale } = this.scene.viewing.viewpoint;
    const metres = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].find((length) => length * scale >= 60) ?? 200;
    const [bar, text] = [this.#scale.firstElementChild as HTMLElement, this.#scale.lastElementChild as HTMLElement];
    bar.style.width = `${Math.min(150, metres * scale)}px`;
    setText(text, metres < 1 ? `${metres * 100} cm` : `${metres} m`);
  }

  /** The first seconds: what the page waits for. */
  #drawWelcome(): void {
    const { connection } = this.scene;
    const isShown = this.scene.fixedFrame === null || !this.scene.displays.all.some(({ receivedMs }) => receivedMs !== null);
    this.#welcome.hidden = !isShown;
    if (!isShown) return;
    const { state } = connection.status;
    const now = performance.now();
    if (state !== "live") this.#connectedMs = now;
    const [title, text] =
      state === "connecting" ? ["Preparing…", "Connecting to the robot's program."]
      : state === "lost" ? ["Not connected", "Start the robot again, for example with navette demo. The page reconnects by itself."]
      : connection.topics.size === 0 ? ["Preparing…", "The program is starting its nodes."]
      : now - this.#connectedMs < FIRST_MS ? ["Preparing…", "Waiting for the first map, scan or transform."]
      : ["Nothing to draw yet", "No map, scan or transform has arrived. Open Topics to see what the program publishes."];
    const key = `${title}${text}`;
    if (this.#welcome.dataset["key"] === key) return;
    this.#welcome.dataset["key"] = key;
    const isBusy = title === "Preparing…";
    this.#welcome.replaceChildren(h("i", { class: isBusy ? "spinner" : "spinner still" }), h("strong", {}, title), h("p", {}, text));
  }
}
