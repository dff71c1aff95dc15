// A browser on the live view's page: says what it reads, sends a goal.
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
  await page.goto(url);
  const text = async (selector) => (await page.textContent(selector)).trim();
  const until = (check) => page.waitForFunction(check, null, { timeout: 10_000 });
  await until(() => document.querySelector("#link").className === "live");
  await until(() => document.querySelector("#headline").textContent === "Waiting for goal");
  await until(() => /Hz/.test([...document.querySelectorAll("#topics tr")].find((row) => row.cells[0].textContent === "/chatter")?.cells[3].textContent));
  await page.fill("#x", "6");
  await page.fill("#y", "-12,5");
  await page.click("#go");
  await until(() => /is sent/.test(document.querySelector("#answer").textContent));
  const rows = await page.$$eval("#topics tr", (all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const open = new URL(await page.getAttribute("#open", "href"));
  console.log(JSON.stringify({
    title: await page.title(), address: await text("#address"), foxglove: open.searchParams.get("ds.url"),
    position: await text("#position"), rows, nodes: await text("#nodes"), problems,
  }));
} finally {
  await browser.close();
}
