/** The connection to a Foxglove WebSocket server: Navette's, foxglove_bridge and others. */

import { FoxgloveClient, type ServerInfo } from "@foxglove/ws-protocol";
import { nextFrame } from "../ui/frames";
import type {
  Connection, ConnectionEvents, ConnectionStatus, Dispose, Message, NodeReport, ParameterInfo, ParameterValue,
  PlaybackState, Statistics, SubscribeOptions, Topic,
} from "./connection";
import { Events } from "./events";
import { loginRefusal } from "./login";
import { type ParameterText, ParameterStore } from "./parameter_store";
import { PlaybackControl } from "./playback_control";
import { Publishers } from "./publishers";
import { ServerSocket } from "./server_socket";
import { ServiceCalls } from "./service_calls";
import { SpeedMeter } from "./speed_meter";
import { Subscriptions } from "./subscriptions";
import { TopicStore } from "./topic_store";

const RETRY_MS = [500, 1000, 2000, 3000];
/** A page in the background for this long gives up its subscriptions. */
const HIDDEN_MS = 5000;
/** What Navette's server offers to this page. */
const OWN_OPERATIONS = ["subscribeNodes", "applyGridUpdates"];
const LEVELS = ["info", "warning", "error"] as const;

interface Link {
  readonly socket: ServerSocket;
  readonly client: FoxgloveClient;
  readonly publishers: Publishers;
}

export class FoxgloveConnection implements Connection {
  #status: ConnectionStatus = { state: "connecting", reason: "" };
  #info: ServerInfo | null = null;
  #link: Link | null = null;
  #nodes: readonly NodeReport[] = [];
  #blockedS = 0;
  #lastFrameMs = 0;
  #retries = 0;
  #retryTimer: ReturnType<typeof setTimeout> | undefined;
  #hiddenTimer: ReturnType<typeof setTimeout> | undefined;
  #assetRequests = 0;
  readonly #assets = new Map<number, { resolve: (data: ArrayBuffer) => void; reject: (reason: Error) => void }>();
  readonly #events = new Events<ConnectionEvents>();
  readonly #topics = new TopicStore();
  readonly #subscriptions = new Subscriptions(
    (topic) => this.#topics.channelsOf(topic),
    ({ topic, encoding }) => {
      const text = `Messages of ${topic} are encoded as ${encoding}, which this page cannot read (cdr of ROS 2 and json).`;
      this.#events.emit("notice", { level: "warning", text });
    },
  );
  readonly #parameters = new ParameterStore();
  readonly #services = new ServiceCalls();
  readonly #playback = new PlaybackControl((frame) => this.#link?.socket.send(frame));
  readonly #time = new SpeedMeter();

  constructor(
    readonly address: string,
    readonly query: string,
  ) {
    document.addEventListener("visibilitychange", () => this.#onVisibility());
  }

  get status(): ConnectionStatus { return this.#status; }
  get topics(): ReadonlyMap<string, Topic> { return this.#topics.topics; }
  get services(): ReadonlyMap<string, string> { return this.#services.types; }
  get parameters(): ReadonlyMap<string, ParameterInfo> { return this.#parameters.infos; }
  get nodes(): readonly NodeReport[] { return this.#nodes; }
  get playback(): PlaybackState | null { return this.#playback.state; }
  get nowNs(): bigint { return this.#time.nowNs; }
  get speed(): number | null { return this.#time.speed; }
  get silenceS(): number { return this.#status.state === "live" ? (performance.now() - this.#lastFrameMs) / 1000 : 0; }
  get blockedS(): number { return this.#blockedS; }

  on<K extends keyof ConnectionEvents>(event: K, callback: (value: ConnectionEvents[K]) => void): Dispose {
    return this.#events.on(event, callback);
  }

  connect(): void {
    clearTimeout(this.#retryTimer);
    if (this.#link) return;
    this.#setStatus({ state: "connecting", reason: this.#status.reason });
    const socket = new ServerSocket(`${this.address}/${this.query}`, {
      frame: () => (this.#lastFrameMs = performance.now()),
      text: (operation, document) => this.#onOwnText(operation, document),
      playback: (frame) => {
        this.#playback.take(frame);
        if (frame.didSeek) {
          this.#time.clear();
          this.#reset();
        }
        this.#time.take(frame.positionNs, performance.now());
        this.#later("playback", () => this.#playback.state);
      },
    });
    const client = new FoxgloveClient({ ws: socket });
    const publishers = new Publishers(
      client,
      () => this.#info?.supportedEncodings ?? [],
      (type) => [...this.#topics.channels.values()].find(({ schemaName }) => schemaName === type)?.schema,
    );
    this.#link = { socket, client, publishers };
    this.#listen(client);
  }

  subscribe<T = unknown>(topic: string, options: SubscribeOptions, callback: (message: Message<T>) => void): Dispose {
    return this.#subscriptions.add(topic, options, callback);
  }

  statistics(topic: string): Statistics | null {
    return this.#subscriptions.statistics(topic, this.nowNs);
  }

  publish(topic: string, type: string, message: object): boolean {
    if (!this.#link || this.#status.state !== "live") return false;
    this.#link.publishers.publish(topic, type, message);
    return true;
  }

  async callService<T = unknown>(service: string, request: object): Promise<T> {
    const client = this.#client();
    const { payload, response } = this.#services.begin(service, request);
    client.sendServiceCallRequest(payload);
    return response;
  }

  async setParameter(name: string, value: ParameterValue): Promise<void> {
    const client = this.#client();
    const { id, parameter, done } = this.#parameters.change(name, value);
    client.setParameters([parameter], id);
    await done;
  }

  async fetchAsset(uri: string): Promise<ArrayBuffer> {
    const client = this.#client();
    const id = (this.#assetRequests += 1);
    return new Promise((resolve, reject) => {
      this.#assets.set(id, { resolve, reject });
      client.fetchAsset(uri, id);
    });
  }

  controlPlayback(request: { play?: boolean; seekNs?: bigint; speed?: number; step?: boolean }): void {
    this.#playback.control(request);
  }

  #client(): FoxgloveClient {
    if (!this.#link || this.#status.state !== "live") throw new Error("not connected");
    return this.#link.client;
  }

  #listen(client: FoxgloveClient): void {
    const isCurrent = (): boolean => this.#link?.client === client;
    client.on("error", () => undefined); // a close follows, or an operation that is not known here
    client.on("close", () => {
      if (isCurrent()) void this.#lose();
    });
    client.on("serverInfo", (info) => this.#welcome(client, info));
    client.on("advertise", (channels) => {
      this.#topics.advertise(channels);
      this.#onTopics();
    });
    client.on("unadvertise", (ids) => {
      this.#topics.unadvertise(ids);
      this.#onTopics();
    });
    client.on("connectionGraphUpdate", (update) => {
      this.#topics.update(update);
      this.#onTopics();
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => this.#subscriptions.accept(subscriptionId, timestamp, data));
    client.on("time", ({ timestamp }) => {
      if (this.#time.take(timestamp, performance.now()) && !this.#playback.state) this.#reset();
      this.#later("time", () => this.nowNs);
    });
    client.on("status", ({ level, message }) => {
      if (!this.#parameters.refuse(message)) this.#events.emit("notice", { level: LEVELS[level], text: message });
    });
    client.on("parameterValues", ({ parameters, id }) => this.#onParameters(this.#parameters.take(parameters, id)));
    client.on("advertiseServices", (services) => {
      this.#services.advertise(services);
      this.#later("services", () => this.services);
    });
    client.on("unadvertiseServices", (ids) => {
      this.#services.unadvertise(ids);
      this.#later("services", () => this.services);
    });
    client.on("serviceCallResponse", ({ callId, data }) => this.#services.respond(callId, data));
    client.on("serviceCallFailure", ({ callId, message }) => this.#services.fail(callId, message));
    client.on("fetchAssetResponse", (response) => {
      const waiting = this.#assets.get(response.requestId);
      this.#assets.delete(response.requestId);
      if ("error" in response) waiting?.reject(new Error(response.error));
      else {
        const { buffer, byteOffset, byteLength } = response.data;
        waiting?.resolve((buffer as ArrayBuffer).slice(byteOffset, byteOffset + byteLength));
      }
    });
  }

  #welcome(client: FoxgloveClient, info: ServerInfo): void {
    const isOther = this.#info !== null && this.#info.sessionId !== info.sessionId;
    this.#info = info;
    this.#retries = 0;
    this.#playback.begin(info);
    this.#setStatus({ state: "live", reason: "" });
    if (isOther) this.#reset();
    this.#subscriptions.attach(client);
    const can = (capability: string): boolean => info.capabilities.includes(capability);
    if (can("connectionGraph")) client.subscribeConnectionGraph();
    if (can("parametersSubscribe")) client.subscribeParameterUpdates([]);
    if (can("parameters")) client.getParameters([], "all");
    if (info.name === "Navette") for (const op of OWN_OPERATIONS) this.#link?.socket.send(JSON.stringify({ op }));
    this.#later("playback", () => this.#playback.state);
  }

  async #lose(): Promise<void> {
    const wasLive = this.#status.state === "live";
    this.#link = null;
    this.#topics.clear();
    this.#services.clear();
    this.#subscriptions.attach(null);
    const parameters = this.#parameters.clear();
    this.#nodes = [];
    this.#blockedS = 0;
    this.#time.clear();
    this.#playback.end();
    for (const { reject } of this.#assets.values()) reject(new Error("not connected"));
    this.#assets.clear();
    const refusal = wasLive ? "" : await loginRefusal(this.address, this.query);
    const reason = refusal || (wasLive ? "The program ended or cannot be reached." : "The program does not run or cannot be reached.");
    this.#setStatus({ state: "lost", reason, ...(refusal && { needsToken: true }) });
    this.#events.emit("topics", []);
    this.#events.emit("services", this.services);
    this.#events.emit("playback", null);
    this.#events.emit("nodes", []);
    if (parameters.length > 0) this.#events.emit("parameters", parameters);
    if (refusal) return; // until another token is entered
    const wait = RETRY_MS[Math.min(this.#retries, RETRY_MS.length - 1)]!;
    this.#retries += 1;
    clearTimeout(this.#retryTimer);
    this.#retryTimer = setTimeout(() => this.connect(), wait);
  }

  #onOwnText(operation: string, document: Record<string, unknown>): void {
    if (operation === "nodes") {
      this.#nodes = document["nodes"] as NodeReport[];
      this.#blockedS = document["blocked"] as number;
      this.#later("nodes", () => this.#nodes);
    } else this.#onParameters(this.#parameters.describe(document["parameters"] as ParameterText[]));
  }

  #onParameters(names: readonly string[]): void {
    if (names.length > 0) nextFrame(() => this.#events.emit("parameters", names));
  }

  #onTopics(): void {
    this.#subscriptions.synchronise();
    this.#later("topics", () => [...this.topics.values()]);
  }

  #onVisibility(): void {
    clearTimeout(this.#hiddenTimer);
    if (document.hidden) this.#hiddenTimer = setTimeout(() => this.#subscriptions.setHidden(true), HIDDEN_MS);
    else this.#subscriptions.setHidden(false);
  }

  #reset(): void {
    this.#subscriptions.forgetMessages();
    this.#events.emit("reset", { topics: "all" });
  }

  #setStatus(status: ConnectionStatus): void {
    this.#status = status;
    this.#events.emit("status", status);
  }

  /** Report a state once per frame, however often it changes. */
  readonly #reports = new Map<keyof ConnectionEvents, () => void>();
  #later<K extends keyof ConnectionEvents>(event: K, value: () => ConnectionEvents[K]): void {
    let report = this.#reports.get(event);
    if (!report) this.#reports.set(event, (report = () => this.#events.emit(event, value())));
    nextFrame(report);
  }
}

/** Make the connection to a server; `connect()` opens it. */
export function connectTo(address: string, query = ""): Connection {
  return new FoxgloveConnection(address.replace(/\/$/, ""), query);
}
