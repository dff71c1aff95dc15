// The page of one live view, connected to another program's Foxglove server.
//
//   node foreign.mjs http://127.0.0.1:PORT BROWSER ws://127.0.0.1:OTHER
import { launch } from "./launch.mjs";

const [url, executablePath, other] = process.argv.slice(2);
const browser = await launch(executablePath);
try {
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  const problems = [];
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(`${url}/?ds=${other}`);
  const until = (check, argument) => page.waitForFunction(check, argument, { timeout: 60_000, polling: 100 });
  await until(() => globalThis.navette?.connection.status.state === "live");
  // The map is drawn, the JSON channel is read, the other encoding is reported.
  await until(() => navette.scene.displays.all.find(({ id }) => id === "/map")?.receivedMs != null);
  await page.evaluate(() => {
    window.received = null;
    window.notices = [];
    navette.connection.on("notice", ({ text }) => notices.push(text));
    navette.connection.subscribe("/battery", {}, ({ value }) => { window.received = value; });
    navette.connection.subscribe("/log", {}, () => undefined);
  });
  await until(() => window.received !== null && notices.length > 0);
  // A parameter, a service, and a goal by coordinates.
  await until(() => navette.connection.parameters.has("speed"));
  await page.evaluate(() => navette.connection.setParameter("speed", 2.5));
  await until(() => navette.connection.parameters.get("speed").value === 2.5);
  await until(() => navette.connection.services.has("/double"));
  const answer = await page.evaluate(() => navette.connection.callService("/double", { data: 21n }).then(({ data }) => Number(data)));
  await page.evaluate(() => navette.connection.publish("/goal_pose", "geometry_msgs/msg/PoseStamped", {
    header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "map" },
    pose: { position: { x: 3, y: 4, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } },
  }));
  const seen = await page.evaluate(() => ({ received, notices, battery: navette.connection.topics.get("/battery").type }));
  console.log(JSON.stringify({ ...seen, answer, problems }));
} finally {
  await browser.close();
}
