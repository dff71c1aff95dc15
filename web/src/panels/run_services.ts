/** Services of a simulation: simulation_interfaces, as Navette, Gazebo and Isaac Sim serve them. */

import type { Connection } from "../connection/connection";
import { CANCEL_GOAL } from "../robot/names";

const SET_STATE = "simulation_interfaces/srv/SetSimulationState";
const PLAYING = 1;
const PAUSED = 2;
const OK = 1;
const ALREADY = 101;

interface Result {
  result: number;
  error_message: string;
}

export interface RunState {
  readonly isPaused: boolean;
  /** Multiple of real time; ∞: as fast as possible; null: the simulation has no rate. */
  readonly rate: number | null;
}

/** The part of the service names before `set_simulation_state`; null without a simulation. */
export function findRun(services: ReadonlyMap<string, string>): string | null {
  for (const [name, type] of services) {
    if (type === SET_STATE && name.endsWith("/set_simulation_state")) return name.slice(0, -"set_simulation_state".length);
  }
  return null;
}

export class RunServices {
  constructor(
    private readonly connection: Connection,
    readonly prefix: string,
  ) {}

  async read(): Promise<RunState> {
    const { state } = await this.#call<{ state: { state: number } }>("get_simulation_state", {});
    const hasRate = this.connection.services.has(`${this.prefix}get_rate`);
    const rate = hasRate ? (await this.#call<{ rate: number }>("get_rate", {})).rate : null;
    return { isPaused: state.state !== PLAYING, rate };
  }

  async setPaused(isPaused: boolean): Promise<void> {
    const { result } = await this.#call<{ result: Result }>("set_simulation_state", { state: { state: isPaused ? PAUSED : PLAYING } });
    check(result);
  }

  async step(steps: number): Promise<void> {
    check((await this.#call<{ result: Result }>("step_simulation", { steps: BigInt(steps) })).result);
  }

  /** Robot and world return to the start; Navette's simulation also clears estimate and maps. */
  async reset(): Promise<void> {
    this.connection.publish(CANCEL_GOAL, "std_msgs/msg/Empty", {});
    check((await this.#call<{ result: Result }>("reset_simulation", { scope: 0 })).result);
  }

  async setRate(rate: number): Promise<void> {
    const { success } = await this.#call<{ success: boolean }>("set_rate", { rate });
    if (!success) throw new Error(`the speed ${rate} is refused: a run that was started with --speed max has none`);
  }

  async #call<T>(name: string, request: object): Promise<T> {
    return this.connection.callService<T>(this.prefix + name, request);
  }
}

function check({ result, error_message: message }: Result): void {
  if (result !== OK && result !== ALREADY) throw new Error(message || `the simulation refused (result ${result})`);
}
