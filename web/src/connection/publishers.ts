/** Channels on which the page publishes: advertised on first use. */

import type { ClientChannelWithoutId } from "@foxglove/ws-protocol";
import { encodeJson, encoderOf, knownDefinition } from "./codec";

export interface PublishingClient {
  advertise(channel: ClientChannelWithoutId): number;
  sendMessage(channelId: number, data: Uint8Array): void;
}

interface Opened {
  readonly id: number;
  readonly encode: (message: object) => Uint8Array;
}

export class Publishers {
  readonly #opened = new Map<string, Opened>();

  constructor(
    private readonly client: PublishingClient,
    /** What the server accepts. */
    private readonly encodings: () => readonly string[],
    /** The definition of a type that the server offers. */
    private readonly definitionOf: (type: string) => string | undefined,
  ) {}

  publish(topic: string, type: string, message: object): void {
    const key = `${topic} ${type}`;
    let opened = this.#opened.get(key);
    if (!opened) this.#opened.set(key, (opened = this.#open(topic, type)));
    this.client.sendMessage(opened.id, opened.encode(message));
  }

  #open(topic: string, type: string): Opened {
    const definition = knownDefinition(type) ?? this.definitionOf(type);
    const channel = { topic, schemaName: type };
    if (definition !== undefined) {
      const schema = { schema: definition, schemaEncoding: "ros2msg" };
      const id = this.client.advertise({ ...channel, ...schema, encoding: "cdr" });
      const encoder = encoderOf(definition);
      return { id, encode: (message) => encoder.encode(message) };
    }
    if (!this.encodings().includes("json")) throw new Error(`the definition of ${type} is not known`);
    return { id: this.client.advertise({ ...channel, encoding: "json" }), encode: encodeJson };
  }
}
