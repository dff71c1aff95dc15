// Pictures of the page in three sizes and two themes, compared with stored ones.
//
//   node pictures.mjs http://127.0.0.1:PORT CHROMIUM STORED NEW [write]
//
// Prints by picture: mean difference of brightness (0 to 255), share of pixels that differ
// by more than 48. Stored pictures are reduced to a quarter: fonts differ between machines.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { launch } from "./launch.mjs";

const [url, executablePath, stored, made, mode] = process.argv.slice(2);
const SIZES = { desktop: [1440, 900], tablet: [820, 1180], phone: [360, 800] };
const browser = await launch(executablePath);

/** Reduce a picture to a quarter; with another one of that size, compare. */
async function reduce(page, picture, other) {
  return page.evaluate(async ([first, second]) => {
    const load = async (data) => createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const draw = (image, width, height) => {
      const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d");
      context.imageSmoothingQuality = "high";
      context.drawImage(image, 0, 0, width, height);
      return [canvas, context.getImageData(0, 0, width, height).data];
    };
    const image = await load(first);
    const [width, height] = [Math.round(image.width / 4), Math.round(image.height / 4)];
    const [canvas, pixels] = draw(image, width, height);
    const bytes = new Uint8Array(await (await canvas.convertToBlob()).arrayBuffer());
    const small = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
    if (!second) return { small };
    const before = await load(second);
    if (before.width !== width || before.height !== height) return { small, mean: 255, share: 1 };
    const [, old] = draw(before, width, height);
    let sum = 0, far = 0;
    for (let at = 0; at < pixels.length; at += 4) {
      const brightness = (data) => 0.299 * data[at] + 0.587 * data[at + 1] + 0.114 * data[at + 2];
      const off = Math.abs(brightness(pixels) - brightness(old));
      sum += off;
      far += off > 48;
    }
    return { small, mean: sum / (width * height), share: far / (width * height) };
  }, [picture, other]);
}

try {
  const plain = await browser.newPage();
  const seen = {};
  for (const [size, [width, height]] of Object.entries(SIZES)) {
    for (const colorScheme of ["light", "dark"]) {
      const name = `${size}-${colorScheme}`;
      const context = await browser.newContext({ viewport: { width, height }, colorScheme, reducedMotion: "reduce", hasTouch: size === "phone" });
      const page = await context.newPage();
      await page.goto(url);
      await page.waitForFunction(() => globalThis.navette?.transforms.frames.includes("base_link") && /\S/.test(document.querySelector("#headline").textContent), null, { timeout: 60_000 });
      await page.waitForFunction(() => navette.scene.displays.all.filter(({ topic, receivedMs }) => ["/map", "/path"].includes(topic) && receivedMs !== null).length === 2, null, { timeout: 60_000 });
      await page.waitForTimeout(1500);
      const picture = (await page.screenshot({ path: `${made}/${name}.png` })).toString("base64");
      const file = `${stored}/${name}.png`;
      const { small, ...difference } = await reduce(plain, picture, existsSync(file) ? readFileSync(file).toString("base64") : null);
      if (mode === "write") writeFileSync(file, Buffer.from(small, "base64"));
      seen[name] = difference;
      await context.close();
    }
  }
  console.log(JSON.stringify(seen));
} finally {
  await browser.close();
}
