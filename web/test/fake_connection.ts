/** A connection without a server, which a test feeds. */

import type {
  Connection, ConnectionEvents, ConnectionStatus, Dispose, Message, NodeReport, ParameterInfo, ParameterValue,
  PlaybackState, Statistics, SubscribeOptions, Topic,
} from "../src/connection/connection";

type Callback = (message: Message<never>) => void;

export class FakeConnection implements Connection {
  status: ConnectionStatus = { state: "live", reason: "" };
  topics = new Map<string, Topic>();
  services = new Map<string, string>();
  parameters = new Map<string, ParameterInfo>();
  nodes: NodeReport[] = [];
  playback: PlaybackState | null = null;
  nowNs = 0n;
  speed: number | null = null;
  silenceS = 0;
  blockedS = 0;
  address = "ws://127.0.0.1:8765";
  query = "";
  /** What the page published: topic, type, message. */
  published: [string, string, object][] = [];
  readonly #listeners = new Map<string, Set<(value: never) => void>>();
  readonly #subscriptions = new Map<string, Set<Callback>>();

  connect(): void {
    this.emit("status", this.status);
  }

  on<K extends keyof ConnectionEvents>(event: K, callback: (value: ConnectionEvents[K]) => void): Dispose {
    const listeners = this.#listeners.get(event) ?? new Set();
    this.#listeners.set(event, listeners.add(callback));
    return () => listeners.delete(callback);
  }

  emit<K extends keyof ConnectionEvents>(event: K, value: ConnectionEvents[K]): void {
    for (const callback of this.#listeners.get(event) ?? []) (callback as (value: ConnectionEvents[K]) => void)(value);
  }

  addTopic(name: string, type: string, ends: Partial<Topic> = {}): void {
    this.topics.set(name, { name, type, publishers: ["/robot"], subscribers: [], isPublished: true, ...ends });
    this.emit("topics", [...this.topics.values()]);
  }

  /** Deliver a message to the subscribers of its topic. */
  send(topic: string, value: unknown): void {
    const message = { topic, type: this.topics.get(topic)?.type ?? "", stampNs: this.nowNs, bytes: 100, value };
    for (const callback of this.#subscriptions.get(topic) ?? []) (callback as (message: Message) => void)(message);
  }

  isSubscribed(topic: string): boolean {
    return (this.#subscriptions.get(topic)?.size ?? 0) > 0;
  }

  subscribe<T>(topic: string, _options: SubscribeOptions, callback: (message: Message<T>) => void): Dispose {
    const callbacks = this.#subscriptions.get(topic) ?? new Set();
    this.#subscriptions.set(topic, callbacks.add(callback));
    return () => callbacks.delete(callback);
  }

  statistics(): Statistics | null {
    return null;
  }

  publish(topic: string, type: string, message: object): boolean {
    this.published.push([topic, type, message]);
    return this.status.state === "live";
  }

  callService(_service: string, _request: object): Promise<never> {
    return Promise.reject(new Error("no services"));
  }

  setParameter(_name: string, _value: ParameterValue): Promise<void> {
    return Promise.resolve();
  }

  fetchAsset(): Promise<ArrayBuffer> {
    return Promise.reject(new Error("no assets"));
  }

  controlPlayback(): void {
    throw new Error("no recording");
  }
}
