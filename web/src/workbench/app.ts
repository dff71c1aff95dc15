/** The page: connection, robot, scene and panels, put together. */

import { connectTo } from "../connection/foxglove";
import { download } from "../panels/format";
import { panelKinds } from "../panels/panel";
import { LogHistory } from "../robot/log_history";
import { Operator } from "../robot/operator";
import { RobotState } from "../robot/robot_state";
import { Scene } from "../scene/scene";
import { Theme, type ThemeChoice } from "../theme/theme";
import { ToolSet } from "../tools/tool_set";
import { driveByKeys } from "../tools/teleop";
import { TransformTree } from "../transforms/transform_tree";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { registerDisplays } from "./displays_panel";
import type { Arrangement } from "./dock";
import { Header } from "./header";
import { forgetLayout, isLayout, rememberedLayout, rememberLayout, SHIPPED, type Layout } from "./layouts";
import { keepToken, LoginDialog, storedToken } from "./login";
import type { HostContext } from "./panel_host";
import { Phone } from "./phone";
import { PlaybackBar } from "./playback_bar";
import { menuItem, popover } from "./popover";
import { SceneView } from "./scene_view";
import { Shortcuts } from "./shortcuts";

const PHONE = "(max-width: 43.99rem), (max-height: 30rem)";
const REMEMBER_MS = 500;

export class App {
  readonly theme = new Theme();
  readonly #token = storedToken();
  readonly connection = connectTo(serverAddress(), this.#token && `?token=${encodeURIComponent(this.#token)}`);
  readonly transforms = new TransformTree();
  readonly log = new LogHistory(this.connection);
  readonly robot: RobotState;
  readonly operator: Operator;
  readonly scene: Scene;
  readonly tools: ToolSet;
  readonly view: SceneView;
  readonly #header: Header;
  readonly #center = h("div", { class: "center" });
  readonly #phone = matchMedia(PHONE);
  #arrangement: Arrangement | null = null;
  #layoutName = SHIPPED[0]!.name;
  #rememberTimer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.transforms.attach(this.connection);
    this.robot = new RobotState(this.connection, this.transforms);
    this.operator = new Operator(this.robot, (text, isBad) => this.view.answer(text, isBad));
    this.scene = new Scene(this.connection, this.transforms, this.theme, this.robot);
    this.tools = new ToolSet(this.scene, this.operator);
    this.view = new SceneView(this.scene, this.tools, this.operator);
    this.#header = new Header(this.robot);
    registerDisplays(this.scene);
    driveByKeys(this.operator);
    this.scene.displays.onChange(() => this.#remember());
    this.scene.onChange(() => this.#remember());
    this.connection.on("notice", ({ level, text }) => this.view.answer(text, level === "error"));
    this.#header.actions.append(...this.#actions());
    document.body.append(this.#header.element, this.#center, new PlaybackBar(this.connection).element);
    this.#login();
  }

  async start(): Promise<void> {
    this.connection.connect();
    this.#phone.addEventListener("change", () => void this.#arrange(this.#layout()));
    const layout = rememberedLayout() ?? SHIPPED[0]!;
    await this.#arrange(layout);
    performance.mark("navette:interactive");
    await this.#applyScene(layout);
  }

  open(kind: string, settings?: Record<string, unknown>): void {
    this.#arrangement?.open(kind, settings);
  }

  /** Docking comes with large screens only. */
  async #arrange(layout: Layout): Promise<void> {
    const context: HostContext = {
      connection: this.connection,
      transforms: this.transforms,
      theme: this.theme,
      log: this.log,
      announce: (text, level) => this.view.answer(text, level === "error"),
      open: (kind, settings) => this.open(kind, settings),
      changed: () => this.#remember(),
    };
    const isPhone = this.#phone.matches;
    const Dock = isPhone ? null : (await import("./dock")).Dock;
    this.#arrangement?.dispose();
    const arrangement = Dock ? new Dock(this.view.element, context) : new Phone(this.view.element, context);
    document.body.classList.toggle("is-phone", isPhone);
    this.#center.replaceChildren(arrangement.element);
    this.#arrangement = arrangement;
    arrangement.restore(layout);
    this.scene.invalidate();
  }

  async #applyScene(layout: Layout): Promise<void> {
    this.#layoutName = layout.name;
    this.scene.displays.setLooks(layout.looks);
    await this.scene.restore(layout.scene).catch(() => undefined); // no WebGL: it stays flat
  }

  async #use(layout: Layout): Promise<void> {
    this.#arrangement?.restore(layout);
    await this.#applyScene(layout);
    this.view.answer(`Layout ${layout.name}.`);
  }

  #layout(): Layout {
    const places = this.#arrangement?.save() ?? SHIPPED[0]!;
    return { version: 1, name: this.#layoutName, ...places, looks: this.scene.displays.looks, scene: this.scene.settings };
  }

  /** A while after the last change. */
  #remember(): void {
    clearTimeout(this.#rememberTimer);
    this.#rememberTimer = setTimeout(() => {
      if (this.#arrangement) rememberLayout(this.#layout());
    }, REMEMBER_MS);
  }

  #actions(): HTMLElement[] {
    const panels = popover("Panels", "plus", (close) => [
      h("h2", {}, "Open a panel"),
      ...panelKinds().map(({ id, title, icon: name, hint }) => menuItem(title, () => { close(); this.open(id); }, name, hint)),
    ], "Panels");
    const layouts = popover("Layout", "layout", (close) => this.#layoutMenu(close));
    const theme = popover("Theme", this.theme.isDark ? "moon" : "sun", (close) => [h("h2", {}, "Theme"), ...(["system", "light", "dark"] as const).map((choice) => this.#themeItem(choice, close))]);
    this.theme.onChange(() => theme.button.replaceChildren(icon(this.theme.isDark ? "moon" : "sun")));
    const all = [panels, layouts, theme, this.#shortcuts().list];
    return [...all.map(({ button }) => button), ...all.map(({ card }) => card)];
  }

  #themeItem(choice: ThemeChoice, close: () => void): HTMLElement {
    const names = { system: "As the system", light: "Light", dark: "Dark" };
    const item = menuItem(names[choice], () => { close(); this.theme.choose(choice); }, { system: "eye", light: "sun", dark: "moon" }[choice]);
    item.setAttribute("aria-pressed", String(this.theme.choice === choice));
    return item;
  }

  #layoutMenu(close: () => void): Node[] {
    const file = h("input", { type: "file", accept: ".json", hidden: true, "aria-label": "Layout file" });
    file.addEventListener("change", () => {
      close();
      void file.files?.[0]?.text().then((text) => this.#load(text));
    });
    const { address, query } = this.connection;
    const copy = menuItem("Copy the address", () => {
      close();
      void navigator.clipboard.writeText(address + (query && `/${query}`)).then(() => this.view.answer("Address copied."));
    }, "copy", address);
    copy.id = "address";
    return [
      h("h2", {}, "Layout"),
      ...SHIPPED.map((layout) => menuItem(layout.name, () => { close(); void this.#use(layout); }, "layout")),
      h("hr"),
      menuItem("Save to a file", () => { close(); this.#save(); }, "download"),
      menuItem("Load from a file", () => file.click(), "upload"),
      menuItem("Reset", () => { close(); forgetLayout(); void this.#use(SHIPPED[0]!); }, "reset"),
      file,
      h("hr"),
      h("h2", {}, "Other programs"),
      copy,
      query === "" && h("a", { class: "item", id: "open", href: foxgloveLink(address), target: "_blank", rel: "noopener" }, icon("upload"), h("span", {}, "Open in Foxglove")),
      h("a", { class: "item", href: `./layout.json${query}`, download: "navette-layout.json" }, icon("download"), h("span", {}, "Layout for Foxglove")),
    ].filter((node) => node !== false);
  }

  #save(): void {
    download("navette-page-layout.json", JSON.stringify(this.#layout(), null, 2), "application/json");
  }

  #load(text: string): void {
    let layout: unknown;
    try {
      layout = JSON.parse(text);
    } catch {
      layout = null;
    }
    if (isLayout(layout)) void this.#use(layout);
    else this.view.answer("This file is not a layout of this page.", true);
  }

  #shortcuts(): Shortcuts {
    const { scene, view, operator, tools } = this;
    return new Shortcuts([
      ...tools.all.map((tool) => ({ key: tool.key, text: tool.title, act: () => tools.choose(tool) })),
      { key: "f", text: "Follow the robot", act: () => scene.viewing.setMode(scene.viewing.mode === "follow" ? "free" : "follow") },
      { key: "a", text: "Show all that is known", act: () => scene.viewing.setMode(scene.viewing.mode === "fit" ? "free" : "fit") },
      { key: "3", text: "3D, from above", act: () => void view.toggleThreeDimensional() },
      { key: "d", text: "Stick", act: () => view.toggleStick() },
      { key: "c", text: "Cancel the goal", act: () => operator.cancel() },
      { key: "p", text: "Pause, resume navigation", act: () => view.togglePause() },
      { key: "t", text: "Light, dark theme", act: () => this.theme.choose(this.theme.isDark ? "light" : "dark") },
      { key: "escape", text: "Drop what was begun", act: () => tools.drop() },
    ]);
  }

  #login(): void {
    const dialog = new LoginDialog(keepToken);
    document.body.append(dialog.element);
    this.connection.on("status", ({ state, reason }) => {
      if (state === "live") dialog.close();
      else if (/token/i.test(reason)) dialog.ask(reason, this.#token !== "");
    });
  }
}

/** Only without a token: a link would send it to another site. */
function foxgloveLink(address: string): string {
  return `https://app.foxglove.dev/~/view?ds=foxglove-websocket&ds.url=${encodeURIComponent(address)}`;
}

/** This page's server, or another: `?ds=ws://host:port`. */
function serverAddress(): string {
  const given = new URLSearchParams(location.search).get("ds");
  return given ?? `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}`;
}
