import { afterEach, expect, test, vi } from "vitest";
import "../../src/panels/image";
import { panelKind, type PanelContext } from "../../src/panels/panel";
import { LogHistory } from "../../src/robot/log_history";
import { Theme } from "../../src/theme/theme";
import { TransformTree } from "../../src/transforms/transform_tree";
import { FakeConnection } from "../fake_connection";

afterEach(() => vi.unstubAllGlobals());

test("the size of a single compressed image is that of the picture", async () => {
  vi.stubGlobal("createImageBitmap", () => Promise.resolve({ width: 640, height: 480, close: () => undefined }));
  vi.stubGlobal("Option", function (text: string, value: string) {
    return Object.assign(document.createElement("option"), { textContent: text, value });
  });
  const connection = new FakeConnection();
  connection.addTopic("/camera", "sensor_msgs/msg/CompressedImage");
  const context: PanelContext = {
    connection, transforms: new TransformTree(), theme: new Theme(), log: new LogHistory(connection),
    settings: { get: (_key, otherwise) => otherwise, set: () => undefined },
    open: () => undefined, setTitle: () => undefined, announce: () => undefined,
  };
  const container = document.createElement("div");
  const panel = await panelKind("image")!.create(container, context);
  panel.setVisible(true);
  connection.send("/camera", { format: "jpeg", data: new Uint8Array(3) });
  await vi.waitFor(() => expect(container.querySelector(".image-facts")?.textContent).toBe("640 × 480"));
  panel.dispose();
});
