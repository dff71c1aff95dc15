// A browser on the live view's page: prints what it reads, sends a goal.
//
//   node page.mjs http://127.0.0.1:PORT CHROMIUM
import { chromium } from "playwright-core";

const [url, executablePath] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});
try {
  const page = await browser.newPage();
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => { if (!request.url().startsWith(url) && !request.url().startsWith("data:")) problems.push(request.url()); });
  // Every headline, even one shown only briefly.
  await page.addInitScript(() => {
    window.headlines = new Set();
    const look = () => window.headlines.add(document.querySelector("#headline")?.textContent);
    new MutationObserver(look).observe(document, { childList: true, subtree: true, characterData: true });
  });
  await page.goto(url);
  const text = async (selector) => (await page.textContent(selector)).trim();
  const until = (check) => page.waitForFunction(check, null, { timeout: 60_000 });
  await until(() => document.querySelector("#link").className === "live");
  await until(() => window.headlines.has("Waiting for a goal"));
  await until(() => /Hz/.test([...document.querySelectorAll("#topics tr")].find((row) => row.cells[0].textContent === "/chatter")?.cells[3].textContent));
  await page.fill("#x", "6");
  await page.fill("#y", "-12,5");
  await page.click("#go");
  await until(() => /^Goal .* sent\.$/.test(document.querySelector("#answer").textContent));
  // The map view: layers, a goal by a click, velocity commands by a held key.
  await until(() => new Set(new Uint32Array(view.context.getImageData(0, 0, view.canvas.width, view.canvas.height).data.buffer)).size > 5);
  const place = await page.evaluate(() => view.toWorld(200, 100));
  await page.click("#above canvas", { position: { x: 200, y: 100 } });
  await until(() => /^Goal .*sent/.test(document.querySelector("#answer").textContent) && !/6.0, −12.5/.test(document.querySelector("#answer").textContent));
  const layers = await page.$$eval("#layers label", (all) => all.map((label) => label.textContent));
  await page.focus("#above canvas");
  await page.keyboard.down("ArrowUp");
  await page.keyboard.down("ArrowLeft");
  await page.waitForFunction(() => [...document.querySelectorAll("#topics tr")].some((row) => row.cells[0].textContent === "/cmd_vel" && /Hz/.test(row.cells[3].textContent)), null, { timeout: 60_000 });
  await page.keyboard.up("ArrowUp");
  await page.keyboard.up("ArrowLeft");
  const rows = await page.$$eval("#topics tr", (all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const listed = await page.$$eval("#topics tr:not([hidden])", (all) => all.map((row) => row.cells[0].textContent));
  const tree = await page.$$eval("#tree li", (all) => all.map((row) => [row.className, row.textContent, row.style.paddingLeft]));
  // A parameter set by its slider.
  await page.selectOption("#node", "/robot");
  await page.locator('input[aria-label="/robot.speed_mps, slider"]').fill("1.5");
  await until(() => document.querySelector('input[aria-label="/robot.speed_mps"]').value === "1.5");
  const slider = await page.$eval('input[aria-label="/robot.speed_mps, slider"]', ({ min, max }) => [min, max]);
  await page.fill('input[aria-label="/robot.speed_mps"]', "9");
  await page.press('input[aria-label="/robot.speed_mps"]', "Enter");
  await page.locator(".parameters .hint:visible").waitFor();
  const refusal = await page.textContent(".parameters .hint:visible");
  // The planner published its status once only.
  await until(() => document.querySelector("#headline").textContent === "Planner has stopped responding");
  const open = new URL(await page.getAttribute("#open", "href"));
  console.log(JSON.stringify({
    title: await page.title(), address: await text("#address"), foxglove: open.searchParams.get("ds.url"),
    position: await text("#position"), rows, listed, tree, place, layers, nodes: await text("#nodes"), slider, refusal, problems,
  }));
} finally {
  await browser.close();
}
