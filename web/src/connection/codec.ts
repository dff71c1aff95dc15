/** Messages of ROS 2 types from and to bytes: CDR by the definition of the type. */

import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { KNOWN_DEFINITIONS } from "./known_definitions";

/** CDR of a type without fields: the header and the byte that C structures need. */
const NOTHING = new Uint8Array([0, 1, 0, 0, 0]);

export interface Decoder {
  decode(data: ArrayBufferView): unknown;
}

export interface Encoder {
  encode(message: object): Uint8Array;
}

const decoders = new Map<string, Decoder>();
const encoders = new Map<string, Encoder>();

/** How the messages of a channel are written; schemaEncoding is missing at old servers. */
export interface Encoded {
  readonly encoding: string;
  readonly schema: string;
  readonly schemaEncoding?: string | undefined;
}

/** Whether the page can read a channel: CDR by a ROS 2 definition, or JSON. */
export function isReadable({ encoding, schemaEncoding }: Encoded): boolean {
  return encoding === "json" || (encoding === "cdr" && (schemaEncoding ?? "ros2msg") === "ros2msg");
}

const JSON_DECODER: Decoder = { decode: (data) => JSON.parse(new TextDecoder().decode(data)) as unknown };

/** The decoder of a channel that is readable. */
export function channelDecoder({ encoding, schema }: Encoded): Decoder {
  return encoding === "json" ? JSON_DECODER : decoderOf(schema);
}

/** A decoder for a definition in the format ros2msg. */
export function decoderOf(definition: string): Decoder {
  let decoder = decoders.get(definition);
  if (!decoder) {
    decoders.set(definition, (decoder = makeDecoder(definition)));
  }
  return decoder;
}

export function encoderOf(definition: string): Encoder {
  let encoder = encoders.get(definition);
  if (!encoder) {
    encoders.set(definition, (encoder = makeEncoder(definition)));
  }
  return encoder;
}

/** The definition of a type that the page itself publishes; also without a server's. */
export function knownDefinition(type: string): string | undefined {
  return KNOWN_DEFINITIONS[type];
}

function makeDecoder(definition: string): Decoder {
  if (isEmpty(definition)) return { decode: () => ({}) };
  const reader = new MessageReader(parse(definition, { ros2: true }));
  return { decode: (data) => reader.readMessage(data) };
}

function makeEncoder(definition: string): Encoder {
  if (isEmpty(definition)) return { encode: () => NOTHING };
  const writer = new MessageWriter(parse(definition, { ros2: true }));
  return { encode: (message) => writer.writeMessage(message) };
}

/** Whether a definition has no fields: only blanks, comments and constants. */
function isEmpty(definition: string): boolean {
  const own = definition.split(/^=+$/m)[0] ?? "";
  return own.split("\n").every((line) => {
    const text = line.replace(/#.*/, "").trim();
    return text === "" || /^\S+\s+[A-Z][A-Z0-9_]*\s*=/.test(text);
  });
}

/** JSON for servers that accept it; bigint as a number, as ROS tools print it. */
export function encodeJson(message: object): Uint8Array {
  const text = JSON.stringify(message, (_key, value: unknown) => {
    if (typeof value === "bigint") return Number(value);
    if (ArrayBuffer.isView(value) && !(value instanceof DataView)) return Array.from(value as Uint8Array);
    return value;
  });
  return new TextEncoder().encode(text);
}
