/**
 * The WebSocket under `@foxglove/ws-protocol`: takes out the frames that only Navette's server
 * sends (node states, parameter texts, the position of a recording) and passes on the others.
 */

import type { IWebSocket } from "@foxglove/ws-protocol";

/** The current app requests the first, older servers and tools know the second. */
const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
const PLAYBACK_STATE = 5;

export interface PlaybackFrame {
  readonly status: number;
  readonly positionNs: bigint;
  readonly speed: number;
  readonly didSeek: boolean;
  readonly requestId: string;
}

export interface OwnFrames {
  /** Any frame arrived. */
  frame(): void;
  text(operation: string, document: Record<string, unknown>): void;
  playback(frame: PlaybackFrame): void;
}

const OWN_TEXTS = /^\{"op":"(nodes|parameterTexts)"/;

export class ServerSocket implements IWebSocket {
  binaryType = "arraybuffer";
  protocol = "foxglove.websocket.v1";
  onerror: IWebSocket["onerror"] = null;
  onopen: IWebSocket["onopen"] = null;
  onclose: IWebSocket["onclose"] = null;
  onmessage: IWebSocket["onmessage"] = null;
  readonly #socket: WebSocket;

  constructor(url: string, own: OwnFrames) {
    const socket = new WebSocket(url, SUBPROTOCOLS);
    this.#socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = (event) => this.onopen?.(event);
    socket.onerror = (event) => this.onerror?.(event);
    socket.onclose = (event) => this.onclose?.(event);
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      own.frame();
      if (typeof event.data === "string") {
        const match = OWN_TEXTS.exec(event.data);
        if (match) {
          own.text(match[1]!, JSON.parse(event.data) as Record<string, unknown>);
          return;
        }
      } else {
        const view = new DataView(event.data);
        if (view.byteLength > 0 && view.getUint8(0) === PLAYBACK_STATE) {
          own.playback(playbackFrame(view));
          return;
        }
      }
      this.onmessage?.(event);
    };
  }

  get isOpen(): boolean {
    return this.#socket.readyState === WebSocket.OPEN;
  }

  send(data: string | ArrayBuffer | ArrayBufferView): void {
    if (this.isOpen) this.#socket.send(data as string | ArrayBuffer | ArrayBufferView<ArrayBuffer>);
  }

  close(): void {
    this.#socket.close();
  }
}

function playbackFrame(view: DataView): PlaybackFrame {
  const length = view.getUint32(15, true);
  return {
    status: view.getUint8(1),
    positionNs: view.getBigUint64(2, true),
    speed: Number(view.getFloat32(10, true).toPrecision(6)),
    didSeek: view.getUint8(14) !== 0,
    requestId: new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + 19, length)),
  };
}

/** Play or pause at a speed, after an optional seek. */
export function playbackControl(play: boolean, speed: number, seekNs: bigint | null, requestId: string): ArrayBuffer {
  const id = new TextEncoder().encode(requestId);
  const frame = new DataView(new ArrayBuffer(19 + id.length));
  frame.setUint8(0, 3);
  frame.setUint8(1, play ? 0 : 1);
  frame.setFloat32(2, speed, true);
  frame.setUint8(6, seekNs === null ? 0 : 1);
  frame.setBigUint64(7, seekNs ?? 0n, true);
  frame.setUint32(15, id.length, true);
  new Uint8Array(frame.buffer).set(id, 19);
  return frame.buffer;
}
