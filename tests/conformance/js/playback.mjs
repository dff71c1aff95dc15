// A browser on the page of a recording that is played: pauses, steps, seeks, changes
// the rate; prints what it displays.
//
//   node playback.mjs http://127.0.0.1:PORT CHROMIUM [SCREENSHOT]
import { launch } from "./launch.mjs";

const [url, executablePath, screenshot] = process.argv.slice(2);
const browser = await launch(executablePath);
try {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  const until = (check, argument) => page.waitForFunction(check, argument, { timeout: 60_000 });
  await until(() => globalThis.navette?.connection.playback);
  const bar = page.locator(".playback-bar");
  await bar.waitFor();
  const place = async () => (await bar.locator("output").textContent()).split(" / ").map((text) => text.split(":").reduce((sum, part) => sum * 60 + Number(part), 0));
  const status = (wanted) => bar.locator(".playback-status", { hasText: wanted }).waitFor({ timeout: 60_000 });
  const reaches = (least) => until((s) => parseFloat(document.querySelector(".playback-bar output").textContent.split(":")[1]) >= s, least);
  await status("Paused");
  const [, length] = await place();

  await bar.getByRole("button", { name: "Next message" }).click();
  await bar.getByRole("button", { name: "Play", exact: true }).click();
  await status("Playing");
  await reaches(0.4);
  const setRate = async (rate) => {
    await bar.getByRole("combobox", { name: "Rate" }).selectOption(String(rate));
    await until((wanted) => navette.connection.playback.speed === wanted, rate);
  };
  await page.keyboard.press(" ");
  await status("Paused");
  await page.keyboard.press(" ");
  await status("Playing");
  await setRate(0.5);

  const slider = await bar.locator(".playback-slider").boundingBox();
  await page.mouse.click(slider.x + slider.width * 0.75, slider.y + slider.height / 2);
  await reaches(14.2);
  await bar.getByRole("button", { name: "Pause" }).click();
  await status("Paused");
  await page.waitForTimeout(600); // the handle is held for a moment after a seek
  const paused = await place();
  if (screenshot) await page.screenshot({ path: screenshot });
  await setRate(10);
  await bar.getByRole("button", { name: "Play", exact: true }).click();
  await status("Ended");
  const ended = await place();
  await setRate(1);
  await bar.getByRole("button", { name: "Play", exact: true }).click();
  await status("Playing");
  await until(() => parseFloat(document.querySelector(".playback-bar output").textContent.split(":")[1]) < 10);
  const again = await place();
  console.log(JSON.stringify({ length, paused, ended, again, rate: await bar.getByRole("combobox", { name: "Rate" }).inputValue(), problems }));
} finally {
  await browser.close();
}
