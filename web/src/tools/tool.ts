/** A tool decides what a press and a drag on the scene mean. Places are in the fixed frame. */

import type { Primitive } from "../scene/primitives";
import type { Scene } from "../scene/scene";
import type { Operator } from "../robot/operator";
import type { Theme } from "../theme/theme";

export type Place = readonly [x: number, y: number];

export interface ToolContext {
  readonly scene: Scene;
  readonly operator: Operator;
  readonly theme: Theme;
}

export abstract class Tool {
  abstract readonly id: string;
  abstract readonly title: string;
  abstract readonly icon: string;
  /** What to do, in one line. */
  abstract readonly hint: string;
  /** Key that chooses it. */
  abstract readonly key: string;

  constructor(protected readonly context: ToolContext) {}

  /** Why it cannot be used now; empty if it can. */
  get obstacle(): string {
    return "";
  }

  abstract tap(place: Place, px: number, py: number): void;

  /** Whether a drag that begins at a place moves something that is drawn there. */
  canHold(_place: Place): boolean {
    return false;
  }

  beginDrag(_place: Place): boolean {
    return false;
  }

  drag(_place: Place): void {
    // moves the view by default
  }

  endDrag(_place: Place): void {
    // moves the view by default
  }

  /** Drop what was begun. */
  cancel(): void {
    this.context.scene.invalidate();
  }

  overlay(): Primitive[] {
    return [];
  }

  protected get frame(): string | null {
    return this.context.scene.fixedFrame;
  }

  /** A reason if no command reaches a node on the topic. */
  protected needs(topic: string): string {
    const { robot, connection } = this.context.scene;
    if (connection.status.state !== "live") return "Not connected.";
    if (connection.playback) return "A recording is played: no robot receives commands.";
    return robot.isSubscribed(topic) ? "" : `No node subscribes to ${topic}.`;
  }
}
