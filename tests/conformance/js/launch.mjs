// Chromium without a graphics card, or Firefox, both as the system has them.
import { chromium, firefox } from "playwright-core";

const CHROMIUM = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];

/** Firefox is driven by WebDriver BiDi, which is in the browser itself. */
export function launch(executablePath) {
  if (/firefox/.test(executablePath)) return firefox.launch({ channel: "moz-firefox", executablePath });
  return chromium.launch({ executablePath, args: CHROMIUM });
}
