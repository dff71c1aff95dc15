/** What the page asks of a server that plays a recording. */

import { beforeEach, describe, expect, it } from "vitest";
import { PlaybackControl } from "../../src/connection/playback_control";

interface Request {
  readonly plays: boolean;
  readonly speed: number;
  readonly seekNs: bigint | null;
  readonly id: string;
}

function requestOf(frame: ArrayBuffer): Request {
  const view = new DataView(frame);
  return {
    plays: view.getUint8(1) === 0,
    speed: view.getFloat32(2, true),
    seekNs: view.getUint8(6) === 0 ? null : view.getBigUint64(7, true),
    id: new TextDecoder().decode(new Uint8Array(view.buffer, 19)),
  };
}

describe("control of a recording", () => {
  let sent: Request[];
  let texts: string[];
  let control: PlaybackControl;
  const reports = (status: number, requestId: string, speed = 1): void =>
    control.take({ status, positionNs: 0n, speed, didSeek: false, requestId });

  beforeEach(() => {
    sent = [];
    texts = [];
    control = new PlaybackControl((frame) => {
      if (typeof frame === "string") texts.push(frame);
      else sent.push(requestOf(frame));
    });
    const dataStartTime = { sec: 1, nsec: 0 };
    control.begin({ capabilities: ["playbackControl"], dataStartTime, dataEndTime: { sec: 9, nsec: 0 } });
    reports(0, "");
  });

  it("seeks without changing whether it plays", () => {
    control.control({ seekNs: 5n });
    expect(sent[0]).toMatchObject({ plays: true, speed: 1, seekNs: 5n });
  });

  it("keeps what was requested and not reported yet", () => {
    control.control({ play: false });
    reports(0, "another page's"); // sent before the server paused
    control.control({ seekNs: 5n });
    control.control({ speed: 2 });
    control.control({ seekNs: 6n });
    expect(sent.slice(1).map(({ plays, speed }) => [plays, speed])).toEqual([[false, 1], [false, 2], [false, 2]]);
  });

  it("stays paused after a step", () => {
    control.control({ step: true });
    control.control({ seekNs: 5n });
    expect(texts).toEqual(['{"op":"stepPlayback"}']);
    expect(sent[0]).toMatchObject({ plays: false });
  });

  it("follows the server once it has answered", () => {
    control.control({ play: false });
    reports(1, sent[0]!.id);
    reports(0, "another page's", 4); // which plays on
    control.control({ seekNs: 5n });
    expect(sent[1]).toMatchObject({ plays: true, speed: 4 });
  });
});
