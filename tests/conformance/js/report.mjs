// Commands are copied from a report of `navette bench`: on the page's panel, in the report's own
// page, and where the browser does not permit copying.
//
//   node report.mjs http://127.0.0.1:PORT CHROMIUM REPORT.html [FOLDER]
import { pathToFileURL } from "node:url";
import { launch } from "./launch.mjs";

const [url, executablePath, report, folder] = process.argv.slice(2);
const browser = await launch(executablePath);
try {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const page = await context.newPage();
  const problems = [];
  // The page's policy refuses the report's inline styles while it is read; the panel sets them itself.
  page.on("console", (message) => { if (message.type() === "error" && !/inline style/.test(message.text())) problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  const clipboard = () => page.evaluate(() => navigator.clipboard.readText());
  const selected = () => page.evaluate(() => getSelection().toString());
  const permit = () => context.grantPermissions(["clipboard-read", "clipboard-write"]);

  await page.goto(url);
  await page.waitForFunction(() => globalThis.navette?.connection.status.state === "live", null, { timeout: 60_000 });
  await page.evaluate(() => navette.open("report"));
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name: "Open report" }).first().click()]);
  await chooser.setFiles(report);
  const copies = page.getByRole("button", { name: "copy" });
  await copies.first().waitFor();
  const count = await copies.count();
  await permit();
  await copies.nth(1).click();
  await page.waitForFunction(() => document.querySelector("#answer").textContent === "Command copied");
  const panel = await clipboard();
  if (folder) await page.screenshot({ path: `${folder}/report-panel.png` });

  await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: undefined, configurable: true }));
  await copies.first().click();
  await page.waitForFunction(() => document.querySelector("#answer").textContent !== "Command copied");
  const refused = { answer: await page.textContent("#answer"), selected: await selected() };

  await page.goto(pathToFileURL(report).href);
  await copies.first().click();
  await page.getByRole("button", { name: "copied" }).waitFor();
  const file = await clipboard();
  if (folder) await page.screenshot({ path: `${folder}/report-file.png` });
  console.log(JSON.stringify({ count, panel, refused, file, problems }));
} finally {
  await browser.close();
}
