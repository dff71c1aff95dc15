// A browser on the live view's page: shows a point cloud, prints what was drawn.
//
//   node cloud.mjs http://127.0.0.1:PORT CHROMIUM [SCREENSHOT.png]
import { chromium } from "playwright-core";

const [url, executablePath, screenshot] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  const until = (check) => page.waitForFunction(check, null, { timeout: 60_000 });
  const button = page.locator("tr", { hasText: "PointCloud2" }).locator("button");
  const offered = await button.textContent();
  await button.click();
  await until(() => [...view.layers.values()].some((layer) => layer.xyz?.length > 0));
  await until(() => new Set(new Uint32Array(view.context.getImageData(0, 0, view.canvas.width, view.canvas.height).data.buffer)).size > 20);
  const seen = await page.evaluate(() => {
    const [topic, layer] = [...view.layers].find(([, each]) => each.xyz);
    const started = performance.now();
    for (let turn = 0; turn < 10; turn++) drawView(view);
    return { topic, frame: layer.frame, first: [...layer.xyz.subarray(0, 3)], points: layer.xyz.length / 3,
      draw_ms: (performance.now() - started) / 10 };
  });
  await page.click("#fit");
  await page.waitForFunction(() => !view.dirty);
  if (screenshot) await page.screenshot({ path: screenshot });
  console.log(JSON.stringify({ ...seen, offered, problems }));
} finally {
  await browser.close();
}
