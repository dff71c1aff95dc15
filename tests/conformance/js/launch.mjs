// Chromium without a graphics card, or Firefox, both as the system has them.
import { existsSync, readdirSync } from "node:fs";
import { chromium, firefox } from "playwright-core";

const CHROMIUM = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];

/** Firefox is driven by WebDriver BiDi, which is in the browser itself. */
export function launch(executablePath, downloadsPath) {
  if (/firefox/.test(executablePath)) return firefox.launch({ channel: "moz-firefox", executablePath, downloadsPath });
  return chromium.launch({ executablePath, args: CHROMIUM, downloadsPath });
}

/**
 * Return the path of the file that an action downloads.
 *
 * Firefox reports a download without the identifier that Playwright waits for: the file
 * is taken from the folder of downloads, where Firefox writes it as `*.part` first.
 */
export async function downloaded(page, folder, action) {
  const browser = page.context().browser();
  if (browser.browserType().name() !== "firefox") {
    const [download] = await Promise.all([page.waitForEvent("download"), action()]);
    const path = `${folder}/${download.suggestedFilename()}`;
    await download.saveAs(path);
    return path;
  }
  const before = new Set(readdirSync(folder));
  await action();
  for (let tries = 0; tries < 300; tries++) {
    const name = readdirSync(folder).find((each) => !before.has(each) && !each.endsWith(".part"));
    if (name && !existsSync(`${folder}/${name}.part`)) return `${folder}/${name}`;
    await page.waitForTimeout(100);
  }
  throw new Error("no file was downloaded within 30 s");
}

/** Type a text into a field and press Enter: Firefox reports no change of what a script fills in. */
export async function typeInto(page, field, text) {
  await field.selectText();
  await page.keyboard.type(text);
  await page.keyboard.press("Enter");
}
