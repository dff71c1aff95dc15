// Two browser pages on a map that changes: one is open from the beginning, the other is opened at
// the end. Prints how many whole maps the first received, and whether the two pictures become the
// same from above and in 3D; writes them to a folder.
//
//   node grids.mjs http://127.0.0.1:PORT CHROMIUM LAST_CELL FOLDER
import { launch } from "./launch.mjs";

const [url, executablePath, lastCell, folder] = process.argv.slice(2);
const browser = await launch(executablePath);
const problems = [];

async function open() {
  const context = await browser.newContext({ viewport: { width: 700, height: 600 }, reducedMotion: "reduce" });
  const page = await context.newPage();
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  await page.waitForFunction(() => globalThis.navette?.scene.displays.all.some((display) => display.topic === "/map" && display.status().level === "ok"), null, { timeout: 60_000 });
  return page;
}

/** Wait for the value that the last update sets, as the page describes the cell. */
async function isComplete(page) {
  await page.waitForFunction((index) => {
    const [part] = navette.scene.displays.all.find((display) => display.topic === "/map").parts();
    const facts = part?.about(part.primitives[0], { index: Number(index), point: [0, 0, 0] });
    return new Map(facts).get("value") === "77 (77 %)";
  }, lastCell, { timeout: 60_000 });
}

async function areSame(pages, name) {
  for (let tries = 0; tries < 60; tries++) {
    const pictures = [];
    for (const [index, page] of pages.entries()) {
      pictures.push(await page.locator(".scene-view canvas").first().screenshot({ path: `${folder}/${name}-${index}.png` }));
    }
    if (pictures[0].equals(pictures[1])) return true;
    await pages[0].waitForTimeout(250);
  }
  return false;
}

try {
  const first = await open();
  await first.evaluate(() => navette.connection.publish("/begin", "std_msgs/msg/Empty", {}));
  await isComplete(first);
  const wholes = await first.evaluate(() => navette.connection.statistics("/map").count);
  const second = await open();
  await isComplete(second);
  const isSame2d = await areSame([first, second], "2d");
  for (const page of [first, second]) await page.getByRole("button", { name: "3D" }).click();
  await first.evaluate(() => navette.connection.publish("/begin", "std_msgs/msg/Empty", {}));
  await first.waitForFunction(() => navette.scene.displays.all.find((display) => display.topic === "/map").parts()[0].primitives[0].changes.length > 60, null, { timeout: 60_000 });
  const isSame3d = await areSame([first, second], "3d");
  console.log(JSON.stringify({ wholes, isSame2d, isSame3d, problems }));
} finally {
  await browser.close();
}
