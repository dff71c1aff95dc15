// A browser on the live view's page while the robot turns in a rectangular room: how far from
// the walls the page draws the points of the scan.
//
//   node turning.mjs http://127.0.0.1:PORT CHROMIUM HALF_LENGTH_M HALF_WIDTH_M
import { launch } from "./launch.mjs";

const [url, executablePath, ...half] = process.argv.slice(2);
const browser = await launch(executablePath);
try {
  const page = await browser.newPage({ viewport: { width: 700, height: 600 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  const isPlaced = () => globalThis.navette?.scene.displays.all.some((display) => display.type === "sensor_msgs/msg/LaserScan" && display.status().level === "ok") && navette.transforms.frames.includes("map");
  await page.waitForFunction(isPlaced, null, { timeout: 60_000 });
  // A scan from before the page's first transforms is drawn at these: wait for a later one.
  const stamps = await page.evaluate(() => ["odom", "base_link"].map((frame) => String(navette.transforms.links.get(frame).stampNs)));
  const isCovered = (firsts) => {
    const { stamp } = navette.scene.displays.all.find((display) => display.type === "sensor_msgs/msg/LaserScan").message.header;
    return firsts.every((first) => BigInt(stamp.sec) * 1_000_000_000n + BigInt(stamp.nanosec) >= BigInt(first));
  };
  await page.waitForFunction(isCovered, stamps, { timeout: 60_000 });
  await page.evaluate(() => navette.scene.displays.all.forEach((display) => { if (display.type !== "sensor_msgs/msg/LaserScan") navette.scene.displays.change(display, { isVisible: false }); }));
  await page.evaluate(() => navette.scene.chooseFrame("map"));
  const distances = await page.evaluate(async ([halfX, halfY]) => {
    const { scene } = navette;
    const probe = new OffscreenCanvas(1, 1).getContext("2d");
    probe.fillStyle = scene.theme.colour("laser");
    probe.fillRect(0, 0, 1, 1);
    const [laser] = new Uint32Array(probe.getImageData(0, 0, 1, 1).data.buffer);
    const worst = [];
    let before = 0;
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    await frame().then(frame); // until that scan is drawn
    while (worst.length < 60) {
      await new Promise((resolve) => setTimeout(resolve, 40));
      const { canvas } = scene;
      const words = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer);
      const ratio = canvas.width / canvas.clientWidth;
      let [most, sum] = [0, 0];
      words.forEach((word, index) => {
        if (word !== laser) return;
        sum += index;
        const [x, y] = scene.groundAt(((index % canvas.width) + 0.5) / ratio, (Math.floor(index / canvas.width) + 0.5) / ratio);
        most = Math.max(most, Math.min(Math.abs(Math.abs(x) - halfX), Math.abs(Math.abs(y) - halfY)));
      });
      if (sum !== 0 && sum !== before) worst.push(most); // a new picture
      before = sum;
    }
    return worst;
  }, half.map(Number));
  const turned = await page.evaluate(() => navette.scene.robot.motion.yawDeg);
  console.log(JSON.stringify({ distances, turned, problems }));
} finally {
  await browser.close();
}
