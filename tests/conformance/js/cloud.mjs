// A browser on the live view's page: shows a point cloud, prints what was drawn.
//
//   node cloud.mjs http://127.0.0.1:PORT CHROMIUM [SCREENSHOT.png]
import { launch } from "./launch.mjs";

const [url, executablePath, screenshot] = process.argv.slice(2);
const browser = await launch(executablePath);
try {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  const until = (check) => page.waitForFunction(check, null, { timeout: 60_000 });
  await page.waitForFunction(() => globalThis.navette?.scene.displays.all.some(({ type }) => type.endsWith("PointCloud2")), null, { timeout: 60_000 });
  await page.evaluate(() => navette.open("displays"));
  const box = page.getByRole("checkbox", { name: "/velodyne_points" });
  const offered = await box.isChecked() ? "shown" : "hidden";
  await box.check();
  const drawn = () => {
    const { canvas } = navette.scene, { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size > 20;
  };
  await until(drawn);
  const seen = await page.evaluate(() => {
    const display = navette.scene.displays.all.find(({ type }) => type.endsWith("PointCloud2"));
    const [{ frame, primitives: [{ positions }] }] = display.parts();
    return { topic: display.topic, frame, first: [...positions.subarray(0, 3)], points: positions.length / 3 };
  });
  if (screenshot) await page.screenshot({ path: screenshot });
  console.log(JSON.stringify({ ...seen, offered, problems }));
} finally {
  await browser.close();
}
