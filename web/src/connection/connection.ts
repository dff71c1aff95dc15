/** What the page needs of a robot program: topics, services, parameters, time. */

/** A topic, as the server's channels and its connection graph describe it. */
export interface Topic {
  readonly name: string;
  /** ROS 2 name: `sensor_msgs/msg/LaserScan`. */
  readonly type: string;
  /** Full names of the nodes, without this page's own; empty until the graph is known. */
  readonly publishers: readonly string[];
  readonly subscribers: readonly string[];
  /** False for a topic that only has subscribers: it can be published to, not subscribed to. */
  readonly isPublished: boolean;
}

export interface Message<T = unknown> {
  readonly topic: string;
  readonly type: string;
  /** Receive stamp of the server, in the robot's time. */
  readonly stampNs: bigint;
  /** Size of the serialized message. */
  readonly bytes: number;
  /** The decoded message; decoded on the first access, so that a skipped message costs nothing. */
  readonly value: T;
}

export interface SubscribeOptions {
  /**
   * Most callbacks per second of this page's time; messages between are dropped undecoded and
   * the newest is delivered. Default 30.
   */
  readonly rateHz?: number;
  /** Deliver every message, in order (log, transforms). Overrides `rateHz`. */
  readonly every?: boolean;
}

export interface Statistics {
  /** Messages per second of the robot's time; null while it is not known. */
  readonly rateHz: number | null;
  readonly bytesPerS: number;
  readonly count: number;
  /** Newest receive stamp. */
  readonly lastNs: bigint;
}

export type ParameterValue = boolean | number | string | number[] | boolean[] | string[] | Uint8Array;

export interface ParameterInfo {
  /** `/node.name`. */
  readonly name: string;
  readonly node: string;
  readonly value: ParameterValue;
  readonly isWhole: boolean;
  readonly meaning?: string;
  readonly allowed?: string;
  readonly isReadOnly?: boolean;
  readonly low?: number;
  readonly high?: number;
  readonly step?: number;
}

export interface NodeReport {
  readonly name: string;
  readonly state: "alive" | "silent" | "gone" | "unknown";
  /** Seconds in this state. */
  readonly since: number;
}

export interface PlaybackState {
  readonly status: "playing" | "paused" | "buffering" | "ended";
  readonly beginNs: bigint;
  readonly endNs: bigint;
  readonly speed: number;
}

export interface ConnectionStatus {
  readonly state: "connecting" | "live" | "lost";
  /** Empty, or why the connection was lost or a login is required. */
  readonly reason: string;
  /** The server requires another token; it is not tried again by itself. */
  readonly needsToken?: boolean;
}

/** Removes what was added: a subscription, a listener, a channel. */
export type Dispose = () => void;

/** Events of a connection that are no messages. */
export interface ConnectionEvents {
  /** Connected, lost, connecting. After `lost` all topics are gone and come again. */
  status: ConnectionStatus;
  /** Topics, publishers or subscribers changed. */
  topics: readonly Topic[];
  /** A service appeared or left. */
  services: ReadonlyMap<string, string>;
  /** Names of parameters whose value, description or existence changed. */
  parameters: readonly string[];
  nodes: readonly NodeReport[];
  playback: PlaybackState | null;
  /** The robot's time, several times a second. */
  time: bigint;
  /** Time went back: a reset of the simulation, or a seek. What is displayed is outdated. */
  reset: { readonly topics: readonly string[] | "all" };
  /** A message of the server about a request of this page. */
  notice: { readonly level: "info" | "warning" | "error"; readonly text: string };
}

/**
 * A connection to one server. All callbacks run outside the socket's event and in turns that
 * leave room for input (see `ui/frames.ts`); `publish` sends at once.
 */
export interface Connection {
  readonly status: ConnectionStatus;
  readonly topics: ReadonlyMap<string, Topic>;
  /** Service name → type. */
  readonly services: ReadonlyMap<string, string>;
  readonly parameters: ReadonlyMap<string, ParameterInfo>;
  readonly nodes: readonly NodeReport[];
  readonly playback: PlaybackState | null;
  /** The robot's time; 0 before the first. */
  readonly nowNs: bigint;
  /** Robot time per real time, measured; null at first. */
  readonly speed: number | null;
  /** Seconds since the server's last frame while connected. */
  readonly silenceS: number;
  /** Seconds since the program of the live view ran a callback; 0 while it works. */
  readonly blockedS: number;

  connect(): void;
  on<K extends keyof ConnectionEvents>(event: K, callback: (value: ConnectionEvents[K]) => void): Dispose;

  /**
   * Subscribe by topic name, whether the topic exists now or comes later; remains over a
   * reconnection. Subscriptions of one topic share one on the wire.
   */
  subscribe<T = unknown>(topic: string, options: SubscribeOptions, callback: (message: Message<T>) => void): Dispose;
  /** Rate and bandwidth of a topic that something subscribes to; null otherwise. */
  statistics(topic: string): Statistics | null;

  /**
   * Publish a message object of a ROS 2 type, at once. The channel is advertised on first use.
   * Returns false while disconnected.
   */
  publish(topic: string, type: string, message: object): boolean;
  callService<T = unknown>(service: string, request: object): Promise<T>;
  /** Resolves with the new value, or rejects with the node's reason. */
  setParameter(name: string, value: ParameterValue): Promise<void>;
  /** Bytes of `package://…` or another URI that the server serves. */
  fetchAsset(uri: string): Promise<ArrayBuffer>;
  /** Play, pause, seek, change the rate, or step one message of a recording. */
  controlPlayback(request: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void;

  /** `ws://host:port`, without the token. */
  readonly address: string;
  /** `?token=…` for addresses that need it, or empty. */
  readonly query: string;
}
