// A person at the page of `navette demo`, in parts: goals (also with a heading), panels and
// run control, sizes and themes, a thumb on the stick, a page that hangs, keys in panels,
// Stop while something else is open, files that are saved and loaded, a server that ends and returns.
//
//   node workbench.mjs goals|panels|sizes|access|touch|hang|keys|stop|files|restart|offline|measure http://127.0.0.1:PORT BROWSER FOLDER
//
// Prints what the page displays, and what axe finds; the parts `restart` and `offline` print
// "end" or "start" for the server and wait for a line on their input.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createInterface } from "node:readline";
import { downloaded, launch, typeInto } from "./launch.mjs";

const [part, url, executablePath, folder] = process.argv.slice(2);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const browser = await launch(executablePath, folder);
const seen = { problems: [], axe: {} };

async function newPage(options) {
  const context = await browser.newContext({ bypassCSP: true, ...options }); // axe is a script of the test
  const page = await context.newPage();
  page.on("pageerror", (error) => seen.problems.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error") seen.problems.push(message.text()); });
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(url)) seen.problems.push(request.url()); });
  await page.goto(url);
  await page.waitForFunction(() => globalThis.navette?.connection.status.state === "live", null, { timeout: 60_000 });
  return page;
}

async function serious(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] }));
  return violations.filter(({ impact }) => impact === "serious" || impact === "critical").map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160)).join(" | ")}`);
}

/** Taking a picture adds a style to the page, which its policy refuses in Firefox. */
async function picture(page, name) {
  const before = seen.problems.length;
  await page.screenshot({ path: `${folder}/${name}.png` });
  seen.problems.length = before;
}

const PANELS = ["displays", "topics", "nodes", "image", "raw", "plot", "parameters", "log", "graph", "tree", "diagnostics", "run", "report", "frames"];
const until = (page, check, argument, timeout = 90_000) => page.waitForFunction(check, argument, { timeout, polling: 100 });
const desktop = () => newPage({ viewport: { width: 1440, height: 900 }, colorScheme: "light" });

/** Pixels that the text of a select is wider than its room beside the arrow. */
const cutPx = (select) => select.evaluate((element) => {
  const style = getComputedStyle(element);
  const context = new OffscreenCanvas(1, 1).getContext("2d");
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  const room = element.clientWidth - parseFloat(style.paddingLeft) - Math.max(20, parseFloat(style.paddingRight));
  return Math.max(0, context.measureText(element.selectedOptions[0].text).width - room);
});

async function goals() {
  const page = await desktop();
  // The map grows.
  await page.evaluate(() => {
    window.known = [];
    navette.connection.subscribe("/map", {}, ({ value }) => known.push(value.data.reduce((sum, cell) => sum + (cell >= 0), 0)));
  });
  await until(page, () => known.length > 3 && known.at(-1) > known[0]);
  seen.known = await page.evaluate(() => [known[0], known.at(-1)]);

  // A goal by a click, then one with a heading, where the robot came from: it arrives.
  const pixelOf = (place) => page.evaluate(([x, y]) => {
    const { canvas } = navette.scene, box = canvas.getBoundingClientRect();
    let best = null, least = Infinity;
    for (let px = 80; px < canvas.clientWidth - 10; px += 4) {
      for (let py = 60; py < canvas.clientHeight - 90; py += 4) {
        const [gx, gy] = navette.scene.groundAt(px, py);
        const off = Math.hypot(gx - x, gy - y);
        if (off < least) { least = off; best = [box.left + px, box.top + py]; }
      }
    }
    return best;
  }, place);
  const pose = () => page.evaluate(() => navette.transforms.lookUp("map", "base_link").translation.slice(0, 2));
  const start = await pose();
  await until(page, ([x, y]) => {
    const [rx, ry] = navette.transforms.lookUp("map", "base_link").translation;
    return Math.hypot(rx - x, ry - y) > 0.8;
  }, start);
  const answer = () => page.textContent("#answer");
  await page.evaluate(() => {
    window.reached = [];
    navette.connection.subscribe("/planner/status", { every: true }, ({ value: { message, values } }) => {
      if (message !== "reached") return;
      const [x, y] = ["goal_x", "goal_y"].map((wanted) => Number(values.find(({ key }) => key === wanted).value));
      const [rx, ry] = navette.transforms.lookUp("map", "base_link").translation;
      reached.push({ x, y, missed: Math.hypot(rx - x, ry - y) });
    });
  });
  await page.mouse.click(...await pixelOf(start));
  await until(page, () => /sent/.test(document.querySelector("#answer").textContent));
  seen.clicked = await answer();
  await page.getByRole("button", { name: /goal pose|heading/i }).first().click();
  const [hx, hy] = await pixelOf(start);
  await page.mouse.move(hx, hy);
  await page.mouse.down();
  await page.mouse.move(hx, hy - 60, { steps: 5 });
  await page.mouse.up();
  await until(page, (before) => document.querySelector("#answer").textContent !== before, seen.clicked);
  seen.withHeading = await answer();
  // The demo's own goals follow at once: each report counts.
  const arrival = await page.waitForFunction(([x, y]) => reached.find((each) => Math.hypot(each.x - x, each.y - y) < 0.6), start, { timeout: 90_000, polling: 200 });
  seen.missed = (await arrival.jsonValue()).missed;
}

async function panels() {
  const page = await desktop();
  const open = (kind, settings = {}) => page.evaluate(([id, given]) => navette.open(id, given), [kind, settings]);
  // Panels display data.
  await open("log");
  await page.locator(".log-list li").first().waitFor({ timeout: 90_000 });
  seen.log = await page.textContent(".log-list li:first-child .log-node");
  await open("plot", { paths: ["/odom/filtered.twist.twist.linear.x"] });
  await until(page, () => /\d/.test([...document.querySelectorAll(".plot-value")].at(-1)?.textContent ?? ""));
  await open("image", { topic: "/camera" });
  await until(page, () => /\d+ × \d+ · \d/.test(document.querySelector(".image-facts")?.textContent ?? ""));
  seen.image = await page.textContent(".image-facts");
  await open("raw", { topic: "/odom/filtered" });
  await until(page, () => document.querySelectorAll(".raw-tree .raw-row").length > 4);
  seen.raw = await page.textContent(".raw-facts");
  seen.cutPx = [await cutPx(page.getByRole("combobox", { name: "Topic", exact: true }).last()), await cutPx(page.locator("#frame"))];
  await open("graph");
  await until(page, () => document.querySelectorAll(".graph-node").length > 5);
  await open("diagnostics");
  await until(page, () => document.querySelectorAll(".diagnostics-nodes li").length > 5);
  await open("tree");
  await page.locator(".tree-lines li").first().waitFor();
  await open("frames");
  await page.getByText("base_link", { exact: false }).first().waitFor();

  // A parameter acts.
  await open("parameters");
  await page.getByRole("combobox", { name: "Node" }).last().selectOption("/control");
  const slider = page.locator('input[aria-label="/control.cruise_speed_mps, slider"]');
  await slider.fill("0.6");
  await until(page, () => navette.connection.parameters.get("/control.cruise_speed_mps").value === 0.6);

  // Run control: paused time stands, a step advances it, continuing continues.
  await open("run");
  const now = () => page.evaluate(() => Number(navette.connection.nowNs));
  await page.getByRole("button", { name: "Pause", exact: true }).last().click();
  await page.getByRole("button", { name: "Continue", exact: true }).last().waitFor({ timeout: 60_000 });
  await page.waitForTimeout(300);
  const paused = await now();
  await page.waitForTimeout(500);
  seen.whilePaused = (await now()) - paused;
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await until(page, (before) => Number(navette.connection.nowNs) >= before + 1e8, paused);
  await page.waitForTimeout(300);
  seen.step = (await now()) - paused;
  await page.getByRole("button", { name: "Continue", exact: true }).last().click();
  await until(page, (before) => Number(navette.connection.nowNs) > before + 5e8, paused);

  // Reset: the robot is at its start, without the goal and without the map.
  await page.evaluate(() => {
    window.known = [];
    navette.connection.subscribe("/map", {}, ({ value }) => known.push(value.data.reduce((sum, cell) => sum + (cell >= 0), 0)));
  });
  await until(page, () => known.length > 0 && navette.robot.goal !== null);
  const grown = await page.evaluate(() => known.at(-1));
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await until(page, (before) => navette.robot.goal === null && known.at(-1) < 0.9 * before, grown);
  seen.afterReset = [grown, await page.evaluate(() => known.at(-1))];

  seen.axe.panels = await serious(page);
  await picture(page, "desktop-light");
}

async function sizes() {
  // Sizes and themes.
  for (const [name, width, height, colorScheme] of [["desktop-dark", 1440, 900, "dark"], ["tablet-light", 820, 1180, "light"], ["phone-dark", 360, 800, "dark"], ["phone-light", 800, 360, "light"]]) {
    const other = await newPage({ viewport: { width, height }, colorScheme, hasTouch: width < 900 });
    await other.waitForFunction(() => navette.transforms.frames.includes("base_link"), null, { timeout: 60_000 });
    await other.waitForTimeout(1500);
    seen.axe[name] = await serious(other);
    seen[name] = await other.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);
    // The hint is there whole, or not at all.
    if (await other.evaluate(() => { const { scrollHeight, clientHeight } = document.querySelector("#help"); return scrollHeight > clientHeight + 1; })) seen.problems.push(`${name}: the hint is cut off`);
    await picture(other, name);
    await other.context().close();
  }
}

async function access() {
  // Every panel on a large screen and on phones, in both themes.
  for (const [name, width, height] of [["desktop", 1440, 900], ["portrait", 360, 740], ["landscape", 740, 360]]) {
    const page = await newPage({ viewport: { width, height }, colorScheme: "light", hasTouch: width < 900 });
    for (const kind of PANELS) {
      await page.evaluate((id) => navette.open(id), kind);
      await page.waitForTimeout(400);
      for (const theme of ["light", "dark"]) {
        await page.evaluate((choice) => navette.theme.choose(choice), theme);
        seen.axe[`${name} ${kind} ${theme}`] = await serious(page);
      }
      const over = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);
      if (Math.max(...over) > 0) seen.problems.push(`${name} ${kind}: scrolls`);
    }
    seen[name] = await page.evaluate(() => document.querySelectorAll(".phone-tabs [data-kind]").length);
    await page.context().close();
  }
}

async function touch() {
  // A thumb on the stick takes over; without it the robot stops; so it does by Stop.
  const phone = await newPage({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const commander = (text) => phone.waitForFunction((wanted) => document.querySelector("#commander").textContent.startsWith(wanted), text, { timeout: 60_000 });
  await phone.evaluate(() => {
    window.commands = [];
    navette.connection.subscribe("/cmd_vel", { every: true }, ({ value }) => commands.push(value.twist?.linear.x ?? value.linear.x));
  });
  await phone.locator("#drive").tap();
  const stick = await phone.locator("#stick, .stick").first().boundingBox();
  const touch = await phone.context().newCDPSession(phone);
  const at = (type, dy) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x: stick.x + stick.width / 2, y: stick.y + stick.height / 2 + dy }] });
  await at("touchStart", 0);
  await at("touchMove", -stick.height / 2);
  await commander("Operator");
  await phone.waitForFunction(() => Math.max(...commands.slice(-10)) > 0.3, null, { timeout: 60_000 });
  seen.axe.stick = await serious(phone);
  await picture(phone, "stick");
  await at("touchEnd");
  await phone.waitForFunction(() => commands.at(-1) === 0, null, { timeout: 60_000 });
  await phone.locator("#stop").tap();
  await commander("Emergency stop");
  await phone.locator("#release").tap();

  // The page is lost with the thumb on the stick: the robot stops.
  const other = await newPage({ viewport: { width: 800, height: 600 } });
  await other.evaluate(() => {
    navette.connection.publish("/cancel_goal", "std_msgs/msg/Empty", {});
    window.speed = null;
    navette.connection.subscribe("/odom/filtered", {}, ({ value }) => { window.speed = Math.abs(value.twist.twist.linear.x); });
  });
  await at("touchStart", 0);
  await at("touchMove", -stick.height / 2);
  await other.waitForFunction(() => speed > 0.2, null, { timeout: 60_000 });
  await phone.close({ runBeforeUnload: false });
  await other.waitForFunction(() => speed < 0.01, null, { timeout: 60_000 });
  await phone.context().close();
}

async function hang() {
  // A page that hangs displays afterwards what was sent once meanwhile.
  const page = await desktop();
  const other = await newPage({ viewport: { width: 800, height: 600 } });
  await page.evaluate(() => {
    navette.open("image", { topic: "/camera" });
    window.goals = [];
    navette.connection.subscribe("/goal_point", { every: true }, ({ value }) => goals.push(value.point.x));
  });
  await page.waitForTimeout(1500);
  const hanging = page.evaluate(() => { for (const end = performance.now() + 3500; performance.now() < end;); });
  await other.waitForTimeout(2000);
  await other.evaluate(() => navette.operator.sendGoal({ frame: "map", x: -6.25, y: -6.5, yaw: null }));
  await hanging;
  await until(page, () => goals.includes(-6.25));
  await until(page, () => Math.abs((navette.robot.goal?.x ?? 0) + 6.25) < 0.1);
}

async function keys() {
  // Opening a panel, its tab and its sliders leave Space to Stop, and letters to shortcuts.
  const page = await desktop();
  const stops = async (what) => {
    await page.keyboard.press(" ");
    await until(page, () => navette.robot.isStopped);
    seen[what] = await page.evaluate(() => navette.robot.isStopped);
    await page.locator("#release").click();
    await until(page, () => !navette.robot.isStopped);
  };
  await page.getByText("Space stops").waitFor(); // the page knows who drives the robot
  await page.evaluate(() => navette.open("displays"));
  await stops("panel");
  await page.getByRole("tab", { name: "Topics" }).first().click();
  await stops("tab");
  // The focus is visible on a tab: WCAG's ring of two pixels.
  const focused = page.locator(".dv-tab:focus-visible");
  for (let presses = 0; presses < 40 && (await focused.count()) === 0; presses++) await page.keyboard.press("Tab");
  seen.ring = await focused.evaluate((tab) => {
    const { outlineWidth, outlineStyle, outlineColor } = getComputedStyle(tab, "::after");
    const probe = document.createElement("i");
    probe.style.color = "var(--thread)";
    document.body.append(probe);
    return [outlineWidth, outlineStyle, outlineColor === getComputedStyle(probe).color];
  });
  await page.evaluate(() => navette.open("parameters"));
  await page.locator('input[type="range"]').first().focus();
  await stops("slider");
  await page.evaluate(() => navette.open("displays"));
  await page.getByRole("checkbox", { name: "Grid" }).focus();
  await page.keyboard.press("m");
  seen.tool = await page.evaluate(() => navette.tools.chosen.key);
  await page.keyboard.press("?");
  await page.getByRole("dialog", { name: "Keyboard and mouse" }).waitFor();
  seen.axe.help = await serious(page);
}

async function stop() {
  // Whatever is open, Stop looks as before, nothing lies above it, and a click and Space stop.
  const openByButton = (name) => async (page) => {
    await page.getByRole("button", { name, exact: true }).first().click();
    await page.locator(".popover:popover-open").waitFor();
  };
  const openers = {
    shortcuts: openByButton("Shortcuts"),
    panels: openByButton("Panels"),
    layout: openByButton("Layout"),
    theme: openByButton("Theme"),
    goal: openByButton("Goal by coordinates"),
    info: async (page) => {
      const { x, y } = await page.locator("#operate").boundingBox();
      await page.mouse.click(x - 12, y + 20, { button: "right" });
      await page.locator(".info-card").waitFor();
    },
    waypoints: async (page) => {
      await page.evaluate(() => {
        for (let x = 0; x < 12; x++) navette.tools.waypoints.tap([x, 0]);
        navette.tools.choose(navette.tools.waypoints);
      });
      await page.locator(".waypoint-card").waitFor();
    },
  };
  seen.opened = {};
  seen.above = {};
  for (const [name, width, height, colorScheme, panel] of [
    ["desktop", 1440, 900, "light"], ["laptop", 1024, 600, "dark"], ["phone", 360, 640, "light"], ["sheet", 360, 740, "dark", "log"], ["landscape", 740, 360, "light"],
  ]) {
    const page = await newPage({ viewport: { width, height }, colorScheme });
    await until(page, () => navette.robot.driveTopic !== undefined && navette.scene.fixedFrame !== null);
    if (panel) await page.evaluate((kind) => navette.open(kind), panel);
    await page.waitForTimeout(500);
    const isStopped = (wanted) => until(page, (is) => [navette.robot.isStopped, !document.querySelector("#release").hidden, document.body.classList.contains("stopped")].every((each) => each === is), wanted, 30_000);
    const look = async () => {
      const { x, y, width: long, height: high } = await page.locator("#stop").boundingBox();
      const before = seen.problems.length;
      const clip = { x: Math.ceil(x + high / 2), y: Math.ceil(y + 2), width: Math.floor(long - high), height: Math.floor(high - 4) };
      const pixels = (await page.screenshot({ clip, animations: "disabled" })).toString("base64");
      seen.problems.length = before; // see picture()
      return pixels;
    };
    const above = () => page.evaluate(() => {
      const { left, top, width: long, height: high } = document.querySelector("#stop").getBoundingClientRect();
      const points = [.04, .2, .5, .8, .96].flatMap((across) => [.3, .5, .7].map((down) => [left + across * long, top + down * high]));
      return points.map(([x, y]) => document.elementFromPoint(x, y)).filter((each) => each?.id !== "stop").map((each) => each?.className ?? "nothing");
    });
    /** Whether it looks so, after a while at most: cards are placed when they are open. */
    const looks = async (wanted) => {
      for (let tries = 0; tries < 10; tries++) {
        if (await look() === wanted) return true;
        await page.waitForTimeout(100);
      }
      return false;
    };
    await page.mouse.move(1, 1);
    let asUsual = await look();
    while (!await looks(asUsual)) asUsual = await look(); // the page is still laid out
    for (const [what, open] of Object.entries(openers)) {
      if (what === "panels" && width < 1000) continue; // a phone has tabs instead
      await open(page);
      await page.mouse.move(1, 1);
      if (!await looks(asUsual)) seen.problems.push(`${name} ${what}: Stop looks different`);
      (seen.above[name] ??= {})[what] = await above();
      await page.locator("#stop").click({ timeout: 5_000 });
      await isStopped(true);
      await page.evaluate(() => navette.operator.release());
      await isStopped(false);
      if (!(await page.locator(".popover:popover-open, .info-card, .waypoint-card").first().isVisible())) await open(page);
      await page.keyboard.press(" ");
      await isStopped(true);
      await page.evaluate(() => navette.operator.release());
      await isStopped(false);
      await page.keyboard.press("Escape");
      await page.locator(".popover:popover-open").waitFor({ state: "detached" });
      await page.evaluate(() => navette.tools.choose(navette.tools.all[0]));
      (seen.opened[name] ??= []).push(what);
    }
    await page.context().close();
  }
}

async function files() {
  // Plots and layouts are saved; a layout is loaded; what is refused says why where it was set.
  const page = await desktop();
  await page.evaluate(() => navette.open("plot", { paths: ["/odom/filtered.twist.twist.angular.z"] }));
  await until(page, () => /\d/.test([...document.querySelectorAll(".plot-value")].at(-1)?.textContent ?? ""));
  await page.waitForTimeout(500);
  const saved = (name) => downloaded(page, folder, () => page.getByRole("button", { name, exact: true }).last().click());
  seen.csv = readFileSync(await saved("Save as CSV"), "utf8").split("\n").slice(0, 2);
  seen.png = [...readFileSync(await saved("Save as PNG")).subarray(0, 4)];
  const menu = () => page.getByRole("button", { name: "Layout" }).first().click();
  await menu();
  const layout = await saved("Save to a file");
  await menu();
  await page.getByRole("button", { name: "Recordings" }).click();
  await until(page, () => ![...document.querySelectorAll(".plot-name")].some(({ textContent }) => textContent.includes("angular.z")));
  await menu();
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name: "Load from a file" }).click()]);
  await chooser.setFiles(layout);
  await page.locator(".plot-name", { hasText: "angular.z" }).first().waitFor();

  await page.evaluate(() => navette.open("parameters"));
  await page.getByRole("combobox", { name: "Node" }).last().selectOption("/control");
  const field = page.locator('input[aria-label="/control.acceleration_mps2"]');
  await typeInto(page, field, "-5");
  await page.getByText("must be >= 0.01").first().waitFor();
  seen.parameter = await field.inputValue();
  await page.evaluate(() => navette.operator.sendGoal({ frame: "nowhere", x: 1, y: 1, yaw: null }));
  await until(page, () => /refused/i.test(document.querySelector("#answer").textContent));
  seen.goal = await page.textContent("#answer");
}

async function restart() {
  const page = await desktop();
  // The server ends and returns.
  const problemsBefore = seen.problems.length;
  console.log("end");
  await until(page, () => navette.connection.status.state === "lost");
  seen.lost = await page.textContent("#headline");
  await until(page, () => /^Not connected\./.test(document.querySelector("#help").textContent));
  await createInterface({ input: process.stdin })[Symbol.asyncIterator]().next();
  await until(page, () => navette.connection.status.state === "live");
  await until(page, () => navette.connection.topics.has("/map"));
  await until(page, () => navette.connection.statistics("/tf")?.count > 0);
  seen.problems = seen.problems.slice(0, problemsBefore); // refused connections meanwhile
}

async function offline() {
  // The page opens while the server is away, says so, and works when the server is back.
  const page = await desktop();
  const session = await page.context().newCDPSession(page);
  seen.manifest = (await session.send("Page.getAppManifest")).errors;
  seen.installability = (await session.send("Page.getInstallabilityErrors")).installabilityErrors.map(({ errorId }) => errorId);
  await page.evaluate(() => navigator.serviceWorker.ready);
  await until(page, () => navigator.serviceWorker.controller !== null);
  console.log("end");
  const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
  await lines.next();
  const problemsBefore = seen.problems.length;
  await page.reload();
  await until(page, () => globalThis.navette?.connection.status.state === "lost");
  await until(page, () => document.querySelector("#headline").textContent !== "Connecting");
  seen.lost = [await page.textContent("#headline"), await page.textContent(".welcome strong")];
  seen.axe.offline = await serious(page);
  await picture(page, "offline");
  console.log("start");
  await lines.next();
  await until(page, () => navette.connection.status.state === "live" && navette.connection.topics.has("/map"));
  seen.problems = seen.problems.slice(0, problemsBefore); // refused connections meanwhile
}

async function measure() {
  // Lengths by clicks, which add up, and by a drag; the view stays where it is.
  const page = await desktop();
  await until(page, () => navette.scene.fixedFrame !== null);
  await page.keyboard.press("m");
  await page.evaluate(() => {
    navette.scene.viewing.setMode("free");
    navette.scene.viewing.viewpoint.scale = 60;
    navette.scene.invalidate();
  });
  const { x, y } = await page.locator(".scene-view canvas").boundingBox();
  const perM = await page.evaluate(() => navette.scene.viewing.viewpoint.scale);
  const length = () => page.evaluate(() => navette.tools.chosen.overlay().find(({ kind }) => kind === "label")?.text ?? null);
  const [left, top] = [x + 300, y + 200];
  for (const [dx, dy] of [[0, 0], [2, 0], [2, 1]]) await page.mouse.click(left + dx * perM, top + dy * perM);
  seen.clicked = await length();
  await page.mouse.move(left, top);
  await page.mouse.down();
  await page.mouse.move(left + 3 * perM, top + 4 * perM, { steps: 4 });
  seen.dragging = await length();
  await page.mouse.up();
  seen.dragged = await length();
  await picture(page, "measure");
  await page.keyboard.press("Escape");
  seen.after = await length();

  // Esc drops planned waypoints as well, beside another tool too.
  const planned = () => page.evaluate(() => navette.tools.waypoints.planned.length);
  seen.planned = [];
  for (const beside of [null, "m"]) {
    await page.keyboard.press("w");
    for (const dx of [0, 2]) await page.mouse.click(left + dx * perM, top);
    if (beside !== null) await page.keyboard.press(beside);
    seen.planned.push(await planned());
    await page.keyboard.press("Escape");
    seen.planned.push(await planned());
  }
}

try {
  await { goals, panels, sizes, access, touch, hang, keys, stop, files, restart, offline, measure }[part]();
  console.log(JSON.stringify(seen));
} finally {
  await browser.close();
}
