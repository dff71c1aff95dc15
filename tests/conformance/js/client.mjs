// The published TypeScript client and ROS 2 codec against a running live view.
//
//   node client.mjs ws://127.0.0.1:PORT
//
// Watches /chatter, /map and /lidar until each has come once, publishes a goal in CDR
// made with the published writer, and prints what it saw as one JSON object.
import protocol from "@foxglove/ws-protocol";
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import WebSocket from "ws";

const { FoxgloveClient } = protocol; // CommonJS
const WANTED = ["/chatter", "/map", "/lidar"];
const seen = { messages: {}, errors: [], topics: {}, parameters: {} };
const readers = new Map();
const client = new FoxgloveClient({
  ws: new WebSocket(process.argv[2], [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});

client.on("error", (error) => seen.errors.push(String(error)));
client.on("status", (status) => seen.errors.push(status.message));
client.on("serverInfo", (info) => {
  seen.info = info;
  client.getParameters([], "all");
  client.subscribeConnectionGraph();
});
client.on("time", ({ timestamp }) => { seen.time = String(timestamp); });
client.on("connectionGraphUpdate", (update) => { seen.graph ??= update; });
client.on("parameterValues", ({ parameters, id }) => {
  seen.parameterId = id;
  for (const { name, value } of parameters) seen.parameters[name] = value;
  end();
});
client.on("advertise", (channels) => {
  for (const channel of channels) {
    seen.topics[channel.topic] = channel.schemaName;
    // Every definition that is advertised must parse.
    const definitions = parse(channel.schema, { ros2: true });
    if (WANTED.includes(channel.topic)) {
      readers.set(client.subscribe(channel.id), { topic: channel.topic, reader: new MessageReader(definitions) });
    }
    if (channel.topic === "/goal_point") sendGoal(channel, definitions);
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const { topic, reader } = readers.get(subscriptionId);
  seen.messages[topic] ??= { stamp: String(timestamp), value: reader.readMessage(data) };
  end();
});

function sendGoal(channel, definitions) {
  const goal = client.advertise({ topic: channel.topic, encoding: "cdr", schemaName: "geometry_msgs/PointStamped" });
  client.sendMessage(goal, new MessageWriter(definitions).writeMessage({
    header: { stamp: { sec: 1, nanosec: 2 }, frame_id: "map" },
    point: { x: 6, y: -12.5, z: 0 },
  }));
}
function end() {
  if (WANTED.every((topic) => seen.messages[topic]) && seen.parameterId && seen.time) {
    const plain = (_, value) => ArrayBuffer.isView(value) ? Array.from(value) : typeof value === "bigint" ? String(value) : value;
    console.log(JSON.stringify(seen, plain));
    client.close();
    process.exit(0);
  }
}
setTimeout(() => { console.error("timed out; saw", JSON.stringify(Object.keys(seen.messages)), seen.errors); process.exit(1); }, 60_000);
