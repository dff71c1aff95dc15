/** Channels and the connection graph of a server, merged to topics. */

import type { Channel, ConnectionGraphUpdate } from "@foxglove/ws-protocol";
import type { Topic } from "./connection";

/** The node of the live view publishes what pages send: it is not listed as a node of the robot. */
const OWN = "/viewer";

export class TopicStore {
  readonly channels = new Map<number, Channel>();
  readonly #publishers = new Map<string, readonly string[]>();
  readonly #subscribers = new Map<string, readonly string[]>();
  /** Service → nodes that serve it. */
  readonly providers = new Map<string, readonly string[]>();
  #topics: ReadonlyMap<string, Topic> = new Map();
  #byName = new Map<string, Channel[]>();

  get topics(): ReadonlyMap<string, Topic> {
    return this.#topics;
  }

  /** The channels of a topic: several if it has several types. */
  channelsOf(topic: string): readonly Channel[] {
    return this.#byName.get(topic) ?? [];
  }

  advertise(channels: readonly Channel[]): void {
    for (const channel of channels) this.channels.set(channel.id, channel);
    this.#merge();
  }

  unadvertise(ids: readonly number[]): void {
    for (const id of ids) this.channels.delete(id);
    this.#merge();
  }

  update(graph: ConnectionGraphUpdate): void {
    for (const { name, publisherIds } of graph.publishedTopics) this.#publishers.set(name, publisherIds);
    for (const { name, subscriberIds } of graph.subscribedTopics) this.#subscribers.set(name, subscriberIds);
    for (const { name, providerIds } of graph.advertisedServices) this.providers.set(name, providerIds);
    for (const name of graph.removedServices) this.providers.delete(name);
    for (const name of graph.removedTopics) {
      this.#publishers.delete(name);
      this.#subscribers.delete(name);
    }
    this.#merge();
  }

  clear(): void {
    this.channels.clear();
    this.#publishers.clear();
    this.#subscribers.clear();
    this.providers.clear();
    this.#merge();
  }

  #merge(): void {
    this.#byName = new Map();
    for (const channel of this.channels.values()) {
      const same = this.#byName.get(channel.topic);
      if (same) same.push(channel);
      else this.#byName.set(channel.topic, [channel]);
    }
    const names = new Set([...this.#byName.keys(), ...this.#subscribers.keys(), ...this.#publishers.keys()]);
    const topics = [...names].sort().map((name): [string, Topic] => {
      const publishers = (this.#publishers.get(name) ?? []).filter((node) => node !== OWN);
      const channels = this.#byName.get(name) ?? [];
      // Without a graph, a channel means a publisher.
      const hasGraph = this.#publishers.size + this.#subscribers.size > 0;
      return [
        name,
        {
          name,
          type: channels[0]?.schemaName ?? "",
          publishers,
          subscribers: (this.#subscribers.get(name) ?? []).filter((node) => node !== OWN),
          isPublished: hasGraph ? this.#publishers.has(name) && this.#publishers.get(name)!.length > 0 : channels.length > 0,
        },
      ];
    });
    this.#topics = new Map(topics);
  }
}
