// Measures the page of a running robot in Chromium with software rendering at 1440 x 900:
// time to the first picture and to the first handled key, bytes, frames per second.
//
//   node measure.mjs http://127.0.0.1:PORT CHROMIUM SECONDS
//
// Prints one JSON object. Times are from the start of the navigation; CPU time is that of
// the page's renderer process, which on a busy machine says more than the clock.
import { readFileSync } from "node:fs";
import { launch } from "./launch.mjs";

const [url, executablePath, seconds] = process.argv.slice(2);
const browser = await launch(executablePath);

/** CPU seconds of the processes of a kind below this browser. */
async function cpuS(type) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  return processInfo.filter((each) => each.type === type).reduce((sum, { id }) => {
    const fields = readFileSync(`/proc/${id}/stat`, "utf8").split(") ")[1].split(" ");
    return sum + (Number(fields[11]) + Number(fields[12])) / 100;
  }, 0);
}

async function load(viewport) {
  const context = await browser.newContext({ viewport });
  const page = await context.newPage();
  const before = await cpuS("renderer");
  await page.goto(url, { waitUntil: "commit" });
  const marks = await page.evaluate(() => new Promise((resolve) => {
    const names = ["navette:interactive", "navette:picture"];
    const look = () => {
      const found = names.map((name) => performance.getEntriesByName(name)[0]?.startTime);
      if (found.some((time) => time === undefined)) return void setTimeout(look, 5);
      // A key handled: the tool Measure is chosen.
      const sent = performance.now();
      document.dispatchEvent(new KeyboardEvent("keydown", { key: "m", bubbles: true }));
      requestAnimationFrame(() => resolve({ interactiveMs: found[0], pictureMs: found[1], keyMs: performance.now() - sent }));
    };
    look();
  }));
  const cpu = await cpuS("renderer") - before;
  const bytes = await page.evaluate(() => performance.getEntriesByType("resource").concat(performance.getEntriesByType("navigation")).reduce((sum, { transferSize }) => sum + transferSize, 0));
  return { context, page, figures: { ...marks, rendererCpuS: cpu, bytes } };
}

try {
  await (await load({ width: 1440, height: 900 })).context.close(); // the browser itself starts
  const loads = [];
  for (let count = 0; count < 5; count += 1) {
    const { context, figures } = await load({ width: 1440, height: 900 });
    loads.push(figures);
    await context.close();
  }
  const phone = await load({ width: 390, height: 780 });
  await phone.context.close();
  const { page } = await load({ width: 1440, height: 900 });
  await page.waitForTimeout(3000);
  const [renderer, gpu] = [await cpuS("renderer"), await cpuS("GPU")];
  const measureFrames = (wait) => page.evaluate((wait) => new Promise((resolve) => {
    const gaps = [];
    let last = performance.now();
    const begin = last;
    const step = (now) => {
      gaps.push(now - last);
      last = now;
      if (now - begin < 1000 * wait) return void requestAnimationFrame(step);
      gaps.sort((a, b) => a - b);
      resolve({
        framesPerS: gaps.length / wait, medianMs: gaps[gaps.length >> 1], p99Ms: gaps[Math.floor(0.99 * gaps.length)],
        scenePerS: navette.scene.framesPerS,
      });
    };
    requestAnimationFrame(step);
  }), wait);
  const frames = await measureFrames(Number(seconds));
  const used = { rendererCpu: (await cpuS("renderer") - renderer) / seconds, gpuProcessCpu: (await cpuS("GPU") - gpu) / seconds };
  // The view moves with each frame: a person who drags.
  await page.evaluate(() => {
    const { viewing } = navette.scene;
    viewing.setMode("free");
    let angle = 0;
    const move = () => {
      angle += 0.05;
      viewing.centreOn(2 * Math.cos(angle), 2 * Math.sin(angle));
      navette.scene.invalidate();
      requestAnimationFrame(move);
    };
    requestAnimationFrame(move);
  });
  await page.waitForTimeout(1000);
  const moving = await measureFrames(5);
  console.log(JSON.stringify({ loads, phone: phone.figures, ...frames, ...used, movingFramesPerS: moving.framesPerS, movingScenePerS: moving.scenePerS, movingP99Ms: moving.p99Ms }));
} finally {
  await browser.close();
}
