/**
 * Subscriptions by topic: one on the wire for all callbacks of a topic, messages between two
 * deliveries dropped undecoded, and none on the wire while the page is hidden.
 */

import type { Channel } from "@foxglove/ws-protocol";
import { nextFrame } from "../ui/frames";
import { channelDecoder, isReadable } from "./codec";
import type { Dispose, Message, Statistics, SubscribeOptions } from "./connection";
import { Meter } from "./statistics";

const DEFAULT_RATE_HZ = 30;
/** Of a topic of which every message is delivered, while the page does not get to it. */
const MOST_QUEUED = 2000;
const MOST_QUEUED_BYTES = 16_000_000;

/** The part of a client that subscribes. */
export interface Wire {
  subscribe(channelId: number): number;
  unsubscribe(subscriptionId: number): void;
}

interface Listener {
  readonly callback: (message: Message<never>) => void;
  readonly isEvery: boolean;
  readonly periodMs: number;
  dueMs: number;
}

interface Raw {
  readonly stampNs: bigint;
  readonly data: ArrayBufferView;
  readonly channel: Channel;
}

class TopicSubscription {
  readonly listeners = new Set<Listener>();
  readonly meter = new Meter();
  /** Wire subscription → its channel. */
  readonly wired = new Map<number, Channel>();
  #queue: Raw[] = [];
  #queuedBytes = 0;
  #newest: Raw | null = null;
  #isScheduled = false;
  #timer: ReturnType<typeof setTimeout> | undefined;

  get wantsEvery(): boolean {
    for (const listener of this.listeners) if (listener.isEvery) return true;
    return false;
  }

  accept(raw: Raw): void {
    this.meter.add(raw.stampNs, raw.data.byteLength);
    if (this.wantsEvery) {
      this.#queue.push(raw);
      this.#queuedBytes += raw.data.byteLength;
      while (this.#queue.length > MOST_QUEUED || (this.#queuedBytes > MOST_QUEUED_BYTES && this.#queue.length > 1)) {
        this.#queuedBytes -= this.#queue.shift()!.data.byteLength;
      }
    }
    this.#newest = raw;
    this.#schedule();
  }

  clear(): void {
    this.#queue = [];
    this.#queuedBytes = 0;
    this.#newest = null;
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.meter.reset();
  }

  #schedule(): void {
    if (this.#isScheduled || this.#timer !== undefined) return;
    const now = performance.now();
    let waitMs = Infinity;
    for (const listener of this.listeners) {
      if (!listener.isEvery) waitMs = Math.min(waitMs, listener.dueMs - now);
      else if (this.#queue.length > 0) waitMs = 0;
    }
    if (waitMs === Infinity) return;
    if (document.hidden) waitMs = Math.max(waitMs, 1000); // no frames are drawn
    if (waitMs > 1) {
      this.#timer = setTimeout(() => {
        this.#timer = undefined;
        if (document.hidden) this.#deliver();
        else this.#inFrame();
      }, waitMs);
    } else this.#inFrame();
  }

  #inFrame(): void {
    this.#isScheduled = true;
    nextFrame(() => {
      this.#isScheduled = false;
      this.#deliver();
    });
  }

  #deliver(): void {
    const queue = this.#queue;
    const newest = this.#newest;
    this.#queue = [];
    this.#queuedBytes = 0;
    const now = performance.now();
    const messages = queue.map(messageOf);
    const last = messages.at(-1) ?? (newest ? messageOf(newest) : null);
    let isPending = false;
    for (const listener of this.listeners) {
      if (listener.isEvery) {
        for (const message of messages) listener.callback(message as Message<never>);
      } else if (newest && last && listener.dueMs <= now + 1) {
        listener.dueMs = now + listener.periodMs;
        listener.callback(last as Message<never>);
      } else if (newest) isPending = true;
    }
    if (isPending) this.#schedule();
    else this.#newest = null;
  }
}

export class Subscriptions {
  readonly #topics = new Map<string, TopicSubscription>();
  readonly #byWire = new Map<number, TopicSubscription>();
  #wire: Wire | null = null;
  #isHidden = false;

  readonly #refused = new Set<string>();

  constructor(
    private readonly channelsOf: (topic: string) => readonly Channel[],
    /** Called once for a topic whose messages the page cannot read. */
    private readonly onUnreadable: (channel: Channel) => void,
  ) {}

  add(topic: string, options: SubscribeOptions, callback: (message: Message<never>) => void): Dispose {
    let subscription = this.#topics.get(topic);
    if (!subscription) this.#topics.set(topic, (subscription = new TopicSubscription()));
    const found = subscription;
    const listener: Listener = {
      callback,
      isEvery: options.every ?? false,
      periodMs: 1000 / (options.rateHz ?? DEFAULT_RATE_HZ),
      dueMs: 0,
    };
    // A further subscriber needs the last message of a topic that is published rarely: the
    // server sends it to new subscriptions.
    if (found.listeners.size > 0) this.#unwire(found);
    found.listeners.add(listener);
    this.#sync(topic, found);
    return () => {
      found.listeners.delete(listener);
      if (found.listeners.size > 0) return;
      this.#unwire(found);
      found.clear();
      if (this.#topics.get(topic) === found) this.#topics.delete(topic);
    };
  }

  statistics(topic: string, nowNs: bigint): Statistics | null {
    return this.#topics.get(topic)?.meter.read(nowNs) ?? null;
  }

  /** Connected (or null: lost). */
  attach(wire: Wire | null): void {
    this.#wire = wire;
    this.#byWire.clear();
    for (const subscription of this.#topics.values()) {
      subscription.wired.clear();
      subscription.clear();
    }
    this.synchronise();
  }

  /** Subscribe to the channels that are there now. */
  synchronise(): void {
    for (const [topic, subscription] of this.#topics) this.#sync(topic, subscription);
  }

  /** While hidden, only topics of which every message counts stay subscribed. */
  setHidden(isHidden: boolean): void {
    if (isHidden === this.#isHidden) return;
    this.#isHidden = isHidden;
    this.synchronise();
  }

  /** Queued messages are from before a seek or reset. */
  forgetMessages(): void {
    for (const subscription of this.#topics.values()) subscription.clear();
  }

  accept(subscriptionId: number, stampNs: bigint, data: ArrayBufferView): void {
    const subscription = this.#byWire.get(subscriptionId);
    const channel = subscription?.wired.get(subscriptionId);
    if (subscription && channel) subscription.accept({ stampNs, data, channel });
  }

  #sync(topic: string, subscription: TopicSubscription): void {
    const isWanted = this.#wire !== null && (!this.#isHidden || subscription.wantsEvery);
    const wanted = isWanted ? this.channelsOf(topic).filter((channel) => this.#canRead(channel)) : [];
    for (const [id, channel] of subscription.wired) {
      if (wanted.some((each) => each.id === channel.id)) continue;
      subscription.wired.delete(id);
      this.#byWire.delete(id);
      // A channel that is gone has no subscription any more.
      if (!isWanted && this.#wire) this.#wire.unsubscribe(id);
    }
    for (const channel of wanted) {
      if ([...subscription.wired.values()].some((each) => each.id === channel.id)) continue;
      const id = this.#wire!.subscribe(channel.id);
      subscription.wired.set(id, channel);
      this.#byWire.set(id, subscription);
    }
  }

  #canRead(channel: Channel): boolean {
    if (isReadable(channel)) return true;
    if (!this.#refused.has(channel.topic)) {
      this.#refused.add(channel.topic);
      this.onUnreadable(channel);
    }
    return false;
  }

  #unwire(subscription: TopicSubscription): void {
    for (const id of subscription.wired.keys()) {
      this.#wire?.unsubscribe(id);
      this.#byWire.delete(id);
    }
    subscription.wired.clear();
  }
}

/** A message that is decoded on first access. */
function messageOf({ stampNs, data, channel }: Raw): Message {
  let isDecoded = false;
  let value: unknown;
  return {
    topic: channel.topic,
    type: channel.schemaName,
    stampNs,
    bytes: data.byteLength,
    get value(): unknown {
      if (!isDecoded) {
        value = channelDecoder(channel).decode(data);
        isDecoded = true;
      }
      return value;
    },
  };
}
