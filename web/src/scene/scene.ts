/** The scene: displays, a viewpoint and a renderer, from above or in 3D. */

import type { Connection, Dispose } from "../connection/connection";
import type { RobotState } from "../robot/robot_state";
import type { Theme } from "../theme/theme";
import { apply, IDENTITY, type Vector } from "../transforms/transform";
import type { TransformTree } from "../transforms/transform_tree";
import { h } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { CanvasRenderer } from "./canvas_renderer";
import { DisplayList } from "./display_list";
import type { Surroundings } from "./display";
import { onGround, pick, type Pick } from "./picking";
import { placeOf, type Part } from "./primitives";
import type { DrawItem, Renderer } from "./renderer";
import { boxIn, unionOf, Viewing, type Box, type ViewMode } from "./viewing";

export interface SceneSettings {
  fixedFrame: string | null;
  isThreeDimensional: boolean;
  mode: ViewMode;
}

export class Scene implements Surroundings {
  readonly element = h("div", { class: "scene-view" });
  readonly displays: DisplayList;
  readonly viewing: Viewing;
  /** What a tool draws above everything, in the fixed frame. */
  overlay: () => readonly Part[] = () => [];
  /** Pixels that bars cover. */
  covered = { coveredLeft: 0, coveredTop: 0 };
  #renderer: Renderer;
  #three: Promise<Renderer> | null = null;
  #isThreeDimensional = false;
  /** As chosen; null: by itself. */
  #chosenFrame: string | null = null;
  #items: readonly DrawItem[] = [];
  #frameTimes: number[] = [];
  #hasPicture = false;
  readonly #listeners = new Set<() => void>();

  constructor(
    readonly connection: Connection,
    readonly transforms: TransformTree,
    readonly theme: Theme,
    readonly robot: RobotState,
  ) {
    this.viewing = new Viewing(() => this.invalidate());
    this.#renderer = new CanvasRenderer(this.#newCanvas());
    this.displays = new DisplayList(this, robot);
    this.viewing.onChange(() => this.#changed());
    transforms.onStructure(() => this.#changed());
    new ResizeObserver(() => this.invalidate()).observe(this.element);
    connection.on("status", ({ state }) => {
      if (state === "lost") this.viewing.replace();
    });
  }

  get isThreeDimensional(): boolean {
    return this.#isThreeDimensional;
  }

  /** The chosen frame if it exists; else the root of the robot's frames, or the first that is drawn. */
  get fixedFrame(): string | null {
    const { transforms, robot } = this;
    if (this.#chosenFrame !== null) return this.#chosenFrame;
    const map = this.connection.topics.has("/map") ? this.displays.all.find(({ id }) => id === "/map") : undefined;
    const mapFrame = map?.isVisible ? map.parts()[0]?.frame : undefined;
    if (mapFrame) return mapFrame;
    if (robot.baseFrame !== null) return transforms.root(robot.baseFrame);
    if (transforms.links.size > 0) return transforms.root(transforms.frames[0]!);
    const drawn = this.displays.all.find((display) => display.topic !== null && display.receivedMs !== null && display.parts().length > 0);
    return drawn?.parts()[0]?.frame ?? null;
  }

  get chosenFrame(): string | null {
    return this.#chosenFrame;
  }

  chooseFrame(frame: string | null): void {
    this.#chosenFrame = frame;
    this.displays.all.forEach((display) => display.restyle());
    this.#changed();
  }

  get settings(): SceneSettings {
    return { fixedFrame: this.#chosenFrame, isThreeDimensional: this.#isThreeDimensional, mode: this.viewing.mode };
  }

  async restore({ fixedFrame, isThreeDimensional, mode }: SceneSettings): Promise<void> {
    this.chooseFrame(fixedFrame);
    this.viewing.setMode(mode);
    await this.setThreeDimensional(isThreeDimensional);
  }

  /** Called when settings or frames changed. */
  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  /** Show in 3D or from above; loads three.js the first time. */
  async setThreeDimensional(is: boolean): Promise<void> {
    if (is === this.#isThreeDimensional) return;
    let renderer: Renderer;
    if (is) {
      this.#three ??= import("./three_renderer").then(({ ThreeRenderer }) => new ThreeRenderer(this.#newCanvas(), () => this.invalidate()));
      try {
        renderer = await this.#three;
      } catch (error) {
        this.#three = null;
        throw error;
      }
    } else {
      renderer = new CanvasRenderer(this.#newCanvas());
    }
    this.#isThreeDimensional = is;
    const before = this.#renderer;
    this.#renderer = renderer;
    before.canvas.replaceWith(renderer.canvas);
    if (!is) this.#three = null;
    before.dispose();
    this.displays.update();
    this.#changed();
  }

  get canvas(): HTMLCanvasElement {
    return this.#renderer.canvas;
  }

  invalidate(): void {
    nextFrame(this.#draw);
  }

  /** Frames per second, over the last two seconds. */
  get framesPerS(): number {
    const now = performance.now();
    this.#frameTimes = this.#frameTimes.filter((time) => now - time < 2000);
    return this.#frameTimes.length / 2;
  }

  /** The place on the ground under a pixel, in the fixed frame. */
  groundAt(px: number, py: number): Vector | null {
    return onGround(this.#renderer.ray(this.viewing.viewpoint, px, py));
  }

  project(point: Vector): readonly [number, number] | null {
    return this.#renderer.project(this.viewing.viewpoint, point);
  }

  pick(px: number, py: number): Pick[] {
    return pick(this.#items, this.#renderer.ray(this.viewing.viewpoint, px, py));
  }

  /** Known cells of the map, else clouds; the robot and the goal too. */
  known(): Box | null {
    const boxes: Box[] = [];
    const maps = this.displays.all.filter((display) => display.isVisible && display.bounds());
    const first = maps.find(({ id }) => id === "/map") ?? maps[0];
    if (first) boxes.push(this.#inFixed(first.bounds()!, first.parts()[0]));
    const fixed = this.fixedFrame;
    const base = fixed === null ? null : this.robot.baseIn(fixed);
    if (base) boxes.push(around(base.translation, first ? 0.6 : 4));
    for (const { frame, pose } of this.displays.goal.goals) {
      const fixed_T_goal = fixed === null ? null : this.transforms.lookUp(fixed, frame);
      if (fixed_T_goal) boxes.push(around(apply(fixed_T_goal, pose.translation), 0.6));
    }
    return unionOf(boxes);
  }

  /** The box about a box of the frame of a part, which may be turned. */
  #inFixed(box: Box, part: Part | undefined): Box {
    const fixed = this.fixedFrame;
    const fixed_T_part = fixed === null || !part ? null : placeOf(part, fixed, this.transforms);
    return fixed_T_part ? boxIn(fixed_T_part, box) : box;
  }

  readonly #draw = (): void => {
    const fixed = this.fixedFrame;
    this.#frameTimes.push(performance.now());
    this.#moveView(fixed);
    this.#items = this.#collect(fixed);
    const overlay = this.overlay().map((part) => ({ part, fixed_T_part: IDENTITY, opacity: 1, fail: reportError }));
    this.#renderer.draw([...this.#items, ...overlay], this.viewing.viewpoint, this.theme.colour("unknown"));
    if (!this.#hasPicture && this.robot.baseFrame !== null && fixed !== null) {
      this.#hasPicture = true;
      performance.mark("navette:picture");
    }
  };

  #moveView(fixed: string | null): void {
    const base = fixed === null ? null : this.robot.baseIn(fixed);
    const { mode, viewpoint } = this.viewing;
    const [width, height] = [this.element.clientWidth || 1, this.element.clientHeight || 1];
    if (mode === "follow" && base) this.viewing.centreOn(base.translation[0], base.translation[1]);
    const known = mode === "fit" ? this.known() : null;
    if (known) this.viewing.fit(known, { width, height, ...this.covered }, this.#isThreeDimensional);
    const reach = this.#isThreeDimensional ? 1.6 : 0.5;
    // A few lines more than are visible, so that a small move needs no new ones.
    const step = this.displays.grid.stepM;
    const near = (value: number, round: (value: number) => number): number => step * round(value / step);
    const [cx, cy] = viewpoint.centre;
    const [w, hh] = [(reach * width) / viewpoint.scale, (reach * height) / viewpoint.scale];
    this.displays.grid.show([near(cx - w, Math.floor), near(cy - hh, Math.floor), near(cx + w, Math.ceil), near(cy + hh, Math.ceil), 1 / viewpoint.scale]);
  }

  #collect(fixed: string | null): DrawItem[] {
    if (fixed === null) return [];
    const items: DrawItem[] = [];
    for (const display of this.displays.all) {
      if (!display.isVisible) continue;
      const { opacity, fail } = display;
      for (const part of display.parts()) {
        const fixed_T_part = placeOf(part, fixed, this.transforms);
        if (fixed_T_part) items.push({ part, fixed_T_part, opacity, fail });
      }
    }
    return items;
  }

  #newCanvas(): HTMLCanvasElement {
    const canvas = h("canvas", { tabindex: "0", "aria-label": "Map" });
    if (!this.element.querySelector("canvas")) this.element.prepend(canvas);
    return canvas;
  }

  #changed(): void {
    this.invalidate();
    for (const callback of this.#listeners) callback();
  }
}

function around([x, y]: readonly [number, number, number], metres: number): Box {
  return [x - metres, y - metres, x + metres, y + metres];
}
