/** Services of a simulation: simulation_interfaces, as Navette, Gazebo and Isaac Sim serve them. */

import type { Connection } from "../connection/connection";
import { CANCEL_GOAL, INITIAL_POSE } from "../robot/names";

const GROUND_TRUTH = "/ground_truth";
const CLEAR_MAP = "nav2_msgs/srv/ClearEntireCostmap";
/** While paused no ground truth follows a reset. */
const RELOCATE_MS = 1500;
/** Until scans are placed by the new estimate. */
const SETTLE_MS = 300;
const SET_STATE = "simulation_interfaces/srv/SetSimulationState";
const PLAYING = 1;
const PAUSED = 2;
const OK = 1;
const ALREADY = 101;

interface Result {
  result: number;
  error_message: string;
}

/** Of nav_msgs/Odometry. */
interface Placed {
  header: object;
  pose: { pose: object };
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

  /** Robot and world return to the start; the goal is dropped, maps start empty. */
  async reset(): Promise<void> {
    const { connection } = this;
    connection.publish(CANCEL_GOAL, "std_msgs/msg/Empty", {});
    check((await this.#call<{ result: Result }>("reset_simulation", { scope: 0 })).result);
    await this.#relocate();
    const clearing = [...connection.services].filter(([, type]) => type === CLEAR_MAP);
    await Promise.all(clearing.map(([name]) => connection.callService(name, {})));
  }

  /** Localisation continues from where the simulator has put the robot. */
  async #relocate(): Promise<void> {
    const { connection } = this;
    if (!connection.topics.get(GROUND_TRUTH)?.isPublished) return;
    const sinceNs = connection.nowNs;
    await new Promise<void>((resolve) => {
      const timer = setTimeout(end, RELOCATE_MS);
      const off = connection.subscribe<Placed>(GROUND_TRUTH, { every: true }, ({ stampNs, value: { header, pose } }) => {
        if (stampNs <= sinceNs) return;
        const covariance = Array.from({ length: 36 }, () => 0);
        covariance[0] = covariance[7] = covariance[35] = 1e-4;
        connection.publish(INITIAL_POSE, "geometry_msgs/msg/PoseWithCovarianceStamped", { header, pose: { pose: pose.pose, covariance } });
        clearTimeout(timer);
        setTimeout(end, SETTLE_MS);
      });
      function end(): void {
        off();
        resolve();
      }
    });
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
