// An operator at the live view's page: takes over by keys, lets go, stops, releases.
//
//   node operator.mjs http://127.0.0.1:PORT CHROMIUM TRIES [only-keys]
//
// Prints the times (ms since the epoch) of the key presses, and what the page shows.
import { launch } from "./launch.mjs";

const [url, executablePath, tries, only] = process.argv.slice(2);
const browser = await launch(executablePath);
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
try {
  const page = await browser.newPage({ viewport: { width: 360, height: 800 } }); // a phone
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.addInitScript(() => {
    window.presses = [];
    addEventListener("keydown", (event) => {
      if (!event.repeat) presses.push([event.key, performance.timeOrigin + event.timeStamp]);
    }, true);
  });
  await page.goto(url);
  const until = (check, argument) => page.waitForFunction(check, argument, { timeout: 60_000 });
  const shows = (text) => until((wanted) => document.querySelector("#commander").textContent.startsWith(wanted), text);
  await shows("Navigation");
  const box = await page.locator("#stop").boundingBox();
  const seen = { problems, stop: [Math.round(box.width), Math.round(box.height), box.y + box.height <= 800] };
  // Nothing covers Stop, with or without a panel.
  seen.reachable = [];
  for (const panel of ["topics", "log"]) {
    seen.reachable.push(await page.evaluate(() => {
      const { x, y, width, height } = document.querySelector("#stop").getBoundingClientRect();
      return document.elementFromPoint(x + width / 2, y + height / 2)?.id === "stop";
    }));
    await page.evaluate((id) => navette.open(id), panel);
  }
  seen.wide = await page.evaluate(() => document.documentElement.scrollWidth);
  await page.getByRole("button", { name: "Log", exact: true }).click(); // closes the sheet

  // Each press is a takeover or a change of direction.
  for (let number = 0; number < Number(tries); number++) {
    const key = number % 2 ? "ArrowLeft" : "ArrowRight";
    await page.keyboard.down(key);
    await pause(40 + 13 * (number % 7));
    await page.keyboard.up(key);
    await pause(10);
  }
  if (only) {
    console.log(JSON.stringify({ presses: await page.evaluate(() => presses) }));
    await browser.close();
    process.exit(0);
  }
  await shows("Operator");
  seen.operator = await page.textContent("#commander");
  seen.headline = await page.textContent("#headline");
  // The window loses the focus while a key is held.
  await page.keyboard.down("ArrowUp");
  await pause(300);
  await page.evaluate(() => { window.blurred = performance.timeOrigin + performance.now(); dispatchEvent(new Event("blur")); });
  await pause(1000);
  seen.released = Date.now();
  await page.keyboard.up("ArrowUp");
  seen.blurred = await page.evaluate(() => window.blurred);

  await page.focus("#cancel"); // Space is stop, whatever button has the focus
  await page.keyboard.press("Space");
  await shows("Emergency stop");
  seen.stopped = await page.textContent("#headline");
  await until(() => document.querySelector("#help").textContent.endsWith("Release the stop to drive."));
  await page.keyboard.press("ArrowUp");
  await pause(700);
  seen.answer = await page.textContent("#answer");
  await page.click("#release");
  await until(() => !document.querySelector("#commander").textContent.startsWith("Emergency stop"));
  await page.click("#stop");
  await shows("Emergency stop");
  await page.click("#release");
  await shows("Navigation");
  await until(() => document.querySelector("#goal").textContent.startsWith("2.0, 3.0"));
  await page.click("#cancel");
  seen.cancelled = await page.textContent("#answer");
  await until(() => document.querySelector("#goal").textContent === "–");
  // Space in a text field is a space.
  await page.getByRole("button", { name: "Goal by coordinates" }).click();
  await page.fill("#x", "1");
  await page.press("#x", "Space");
  await pause(300);
  seen.afterText = await page.textContent("#commander");
  seen.presses = await page.evaluate(() => presses);
  console.log(JSON.stringify(seen));
} finally {
  await browser.close();
}
