// A browser on the page of a recording that is played: pauses, steps, seeks, changes
// the rate; says what it sees.
//
//   node playback.mjs http://127.0.0.1:PORT CHROMIUM [SCREENSHOT]
import { chromium } from "playwright-core";

const [url, executablePath, screenshot] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  const until = (check, argument) => page.waitForFunction(check, argument, { timeout: 60_000 });
  const place = async () => (await page.textContent("#playback output")).split(" / ").map((text) => text.split(":").reduce((sum, part) => sum * 60 + Number(part), 0));
  const status = (wanted) => until((s) => document.querySelector("#playback").dataset.status === s, wanted);
  await page.waitForSelector("#playback", { state: "visible", timeout: 60_000 });
  await status("paused");
  const [, length] = await place();

  await page.click('#playback [name="step"]');
  await page.click('#playback [name="play"]');
  await status("playing");
  await until(() => parseFloat(document.querySelector("#playback output").textContent.split(":")[1]) > 0.4);
  const setRate = async (rate) => {
    await page.selectOption('#playback [name="rate"]', String(rate));
    await until((wanted) => playback.answered === playback.requests && playback.speed === wanted, rate);
  };
  await setRate(0.5);

  const slider = await page.locator('#playback [name="place"]').boundingBox();
  await page.mouse.click(slider.x + slider.width * 0.75, slider.y + slider.height / 2);
  await until(() => playback.seeking === null && playback.timer === null && playback.slider.value > 7000);
  await page.locator("h1").click();
  await page.keyboard.press(" ");
  await status("paused");
  const paused = await place();
  if (screenshot) await page.screenshot({ path: screenshot });
  await setRate(50);
  await page.click('#playback [name="play"]');
  await status("ended");
  const ended = await place();
  await setRate(1);
  await page.click('#playback [name="play"]');
  await status("playing");
  const again = await place();
  console.log(JSON.stringify({ length, paused, ended, again, rate: await page.inputValue('#playback [name="rate"]'), problems }));
} finally {
  await browser.close();
}
