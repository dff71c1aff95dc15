/** A server in place of a WebSocket: records what the page sends and sends frames to it. */

type Handler<E> = ((event: E) => void) | null;

export class FakeServer {
  static readonly all: FakeServer[] = [];
  static readonly CONNECTING = 0;
  static readonly OPEN = 1;
  static readonly CLOSED = 3;
  static get last(): FakeServer {
    return FakeServer.all.at(-1)!;
  }

  binaryType = "blob";
  readyState = FakeServer.CONNECTING;
  onopen: Handler<unknown> = null;
  onclose: Handler<unknown> = null;
  onerror: Handler<unknown> = null;
  onmessage: Handler<{ data: string | ArrayBuffer }> = null;
  readonly sent: (Record<string, unknown> | Uint8Array)[] = [];

  constructor(readonly url: string) {
    FakeServer.all.push(this);
  }

  send(data: string | ArrayBuffer | ArrayBufferView): void {
    if (typeof data === "string") this.sent.push(JSON.parse(data) as Record<string, unknown>);
    else this.sent.push(ArrayBuffer.isView(data) ? new Uint8Array(data.buffer, data.byteOffset, data.byteLength) : new Uint8Array(data));
  }

  close(): void {
    this.drop();
  }

  // The server's side

  welcome(info: Record<string, unknown> = {}): void {
    this.readyState = FakeServer.OPEN;
    this.onopen?.({});
    const capabilities = ["clientPublish", "parameters", "parametersSubscribe", "connectionGraph", "services", "time", "assets"];
    this.text({ op: "serverInfo", name: "Navette", capabilities, supportedEncodings: ["cdr", "json"], sessionId: "1", ...info });
  }

  text(document: Record<string, unknown>): void {
    this.onmessage?.({ data: JSON.stringify(document) });
  }

  binary(frame: ArrayBuffer): void {
    this.onmessage?.({ data: frame });
  }

  advertise(...topics: { id: number; topic: string; schemaName: string; schema: string }[]): void {
    this.text({ op: "advertise", channels: topics.map((topic) => ({ encoding: "cdr", schemaEncoding: "ros2msg", ...topic })) });
  }

  message(subscription: number, stampNs: bigint, data: Uint8Array): void {
    const frame = new DataView(new ArrayBuffer(13 + data.length));
    frame.setUint8(0, 1);
    frame.setUint32(1, subscription, true);
    frame.setBigUint64(5, stampNs, true);
    new Uint8Array(frame.buffer).set(data, 13);
    this.binary(frame.buffer);
  }

  time(stampNs: bigint): void {
    const frame = new DataView(new ArrayBuffer(9));
    frame.setUint8(0, 2);
    frame.setBigUint64(1, stampNs, true);
    this.binary(frame.buffer);
  }

  drop(): void {
    this.readyState = FakeServer.CLOSED;
    this.onclose?.({});
  }

  operations(op: string): Record<string, unknown>[] {
    return this.sent.filter((each): each is Record<string, unknown> => !(each instanceof Uint8Array) && each["op"] === op);
  }
}
