// A browser on the live view's page: prints what it reads, sends a goal.
//
//   node page.mjs http://127.0.0.1:PORT CHROMIUM
import { launch, typeInto } from "./launch.mjs";

const [url, executablePath] = process.argv.slice(2);
const browser = await launch(executablePath);
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
  const open = (kind) => page.evaluate((id) => navette.open(id), kind);
  const row = (topic) => page.locator(".topics-table tbody tr", { has: page.getByRole("button", { name: topic, exact: true }) });
  const hasRate = (topic) => row(topic).locator("td").nth(1).filter({ hasText: /^\d/ }).waitFor({ timeout: 60_000 });
  await open("topics");
  await hasRate("/chatter");
  // A goal by its coordinates.
  const byCoordinates = async (x, y) => {
    await page.getByRole("button", { name: "Goal by coordinates" }).click();
    await page.fill("#x", x);
    await page.fill("#y", y);
    await page.click("#go");
  };
  await byCoordinates("6", "-12,5");
  await until(() => /^Goal .* sent\.$/.test(document.querySelector("#answer").textContent));
  // The scene: displays, a goal by a click, velocity commands by a held key.
  await until(() => {
    const { canvas } = navette.scene, { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size > 5;
  });
  const place = await page.evaluate(() => navette.scene.groundAt(200, 100).slice(0, 2));
  await page.click(".scene-view canvas", { position: { x: 200, y: 100 } });
  await until(() => /^Goal .*sent/.test(document.querySelector("#answer").textContent) && !/6.0, −12.5/.test(document.querySelector("#answer").textContent));
  const layers = await page.evaluate(() => navette.scene.displays.all.filter(({ topic, isVisible, receivedMs }) => topic && isVisible && receivedMs !== null).map(({ topic }) => topic));
  await page.focus(".scene-view canvas");
  await page.keyboard.down("ArrowUp");
  await page.keyboard.down("ArrowLeft");
  await hasRate("/cmd_vel");
  await page.keyboard.up("ArrowUp");
  await page.keyboard.up("ArrowLeft");
  const rows = await page.$$eval(".topics-table tbody tr", (all) => all.map(({ cells }) => [cells[0].querySelector("button").textContent, cells[0].querySelector("small").textContent, cells[3].title, cells[1].textContent]));
  const onRequest = await row("/camera").getByRole("button", { name: "Measure /camera" }).count();
  const topics = await page.evaluate(() => [...navette.connection.topics.keys()]);
  await open("tree");
  await page.locator(".tree-lines li").first().waitFor();
  const tree = await page.$$eval(".tree-lines li", (all) => all.map((line) => [line.className, line.textContent]));
  await open("nodes");
  await page.locator("#nodes li").first().waitFor();
  const nodes = await text("#nodes");
  // A parameter set by its slider.
  await open("parameters");
  await page.getByRole("combobox", { name: "Node" }).selectOption("/robot");
  await page.locator('input[aria-label="/robot.speed_mps, slider"]').fill("1.5");
  await until(() => document.querySelector('input[aria-label="/robot.speed_mps"]').value === "1.5");
  const slider = await page.$eval('input[aria-label="/robot.speed_mps, slider"]', ({ min, max }) => [min, max]);
  await typeInto(page, page.locator('input[aria-label="/robot.speed_mps"]'), "9");
  await page.locator(".parameters-list .hint.bad:visible").waitFor();
  const refusal = await page.textContent(".parameters-list .hint.bad:visible");
  // The planner published its status once only.
  await until(() => document.querySelector("#headline").textContent === "Planner has stopped responding");
  await page.getByRole("button", { name: "Layout" }).click();
  const link = new URL(await page.getAttribute("#open", "href"));
  console.log(JSON.stringify({
    title: await page.title(), address: await text("#address small"), foxglove: link.searchParams.get("ds.url"),
    position: await text("#position"), rows, topics, onRequest, tree, place, layers, nodes, slider, refusal, problems,
  }));
} finally {
  await browser.close();
}
