/** All displays in a stable order: one per topic that can be drawn, and those of the page itself. */

import type { Dispose } from "../connection/connection";
import type { RobotState } from "../robot/robot_state";
import { placeOf } from "../robot/robot_state";
import { nextFrame } from "../ui/frames";
import { displayOf } from "./display_kinds";
import { PLAIN_LOOK, type Display, type Look, type Surroundings } from "./display";
import { FramesDisplay, GoalDisplay, GroundGridDisplay, RobotDisplay } from "./displays/robot";

/** Looks that the user changed, by the display's id: part of the layout. */
export type Looks = Record<string, Partial<Look>>;

export class DisplayList {
  readonly grid: GroundGridDisplay;
  readonly frames: FramesDisplay;
  readonly robot: RobotDisplay;
  readonly goal: GoalDisplay;
  readonly #own: readonly Display[];
  readonly #topics = new Map<string, Display>();
  readonly #listeners = new Set<() => void>();
  #looks: Looks = {};
  #sorted: readonly Display[] | null = null;

  constructor(
    private readonly around: Surroundings,
    private readonly state: RobotState,
  ) {
    const size = { value: 16, low: 6, high: 60, unit: "px" };
    this.grid = new GroundGridDisplay(around, null, "", { title: "Grid", order: 20, isShown: true, colour: "grid" });
    const axes = { value: 0.3, low: 0.05, high: 2, unit: "m" };
    this.frames = new FramesDisplay(around, null, "", { title: "Frames", order: 65, isShown: false, size: axes });
    this.robot = new RobotDisplay(around, null, "", { title: "Robot footprint", order: 61, isShown: true, colour: "thread" });
    this.goal = new GoalDisplay(around, null, "", { title: "Goal", order: 55, isShown: true, colour: "thread", size });
    this.#own = [this.grid, this.frames, this.robot, this.goal];
    const { connection, theme, transforms } = around;
    connection.on("topics", () => this.#follow());
    connection.on("reset", ({ topics }) => {
      for (const display of this.all) if (topics === "all" || topics.includes(display.topic ?? "")) display.clear();
    });
    theme.onChange(() => this.all.forEach((display) => display.restyle()));
    transforms.onStructure(() => nextFrame(this.#restyleFrames));
    state.onChange(() => this.#takeState());
  }

  readonly #restyleFrames = (): void => this.frames.restyle();

  /** In the order of drawing. */
  get all(): readonly Display[] {
    this.#sorted ??= [...this.#own, ...this.#topics.values()].sort(
      (a, b) => a.traits.order - b.traits.order || (a.id < b.id ? -1 : 1),
    );
    return this.#sorted;
  }

  /** A display appeared, left, or its look changed. */
  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  get looks(): Looks {
    return this.#looks;
  }

  setLooks(looks: Looks): void {
    this.#looks = looks;
    for (const display of this.all) this.#apply(display);
    this.#changed();
  }

  change(display: Display, change: Partial<Look>): void {
    this.#looks = { ...this.#looks, [display.id]: { ...this.#looks[display.id], ...change } };
    this.#apply(display);
    this.#changed();
  }

  /** What is shown by itself depends on 2D or 3D. */
  update(): void {
    for (const display of this.all) display.update();
    this.#changed();
  }

  #apply(display: Display): void {
    display.look = { ...PLAIN_LOOK, ...this.#looks[display.id] };
    display.update();
    display.restyle();
  }

  #follow(): void {
    const { topics } = this.around.connection;
    let isChanged = false;
    for (const [name, display] of this.#topics) {
      const topic = topics.get(name);
      if (topic?.isPublished && topic.type === display.type) continue;
      // A user's settings remain; the display comes back with the topic.
      display.dispose();
      this.#topics.delete(name);
      isChanged = true;
    }
    for (const topic of topics.values()) {
      if (!topic.isPublished || this.#topics.has(topic.name) || topic.name.includes("/_")) continue;
      const display = displayOf(this.around, topic);
      if (!display) continue;
      this.#topics.set(topic.name, display);
      this.#apply(display);
      isChanged = true;
    }
    if (isChanged) this.#changed();
  }

  #takeState(): void {
    const { baseFrame, outline, goal } = this.state;
    if (this.robot.frame !== baseFrame || this.robot.outline !== outline) {
      this.robot.frame = baseFrame;
      this.robot.outline = outline;
      this.robot.restyle();
    }
    const places = goal ? [{ frame: goal.frame, pose: placeOf(goal), hasHeading: goal.yaw !== null }] : [];
    this.goal.set(places);
  }

  #changed(): void {
    this.#sorted = null;
    this.around.invalidate();
    for (const callback of this.#listeners) callback();
  }
}
