// Node states: the live view probes the nodes of other programs twice a second.
"use strict";

// Topics needed to drive: the loss of a publisher of one of them is shown at once.
const DUTIES = ["/cmd_vel_nav", "/cmd_vel", "/path", "/map", "/costmap", "/odom/filtered", "/odom", "/lidar", "/scan"];
const MUTE_S = 2.5; // reports come every half second

const nodes = {
  reports: [],
  blocked: 0,          // s since the program of the live view ran a callback
  received: null,      // local time of the last report
  duties: new Map(),   // node → the topics it is needed for, kept when it is gone

  start(list, count) { this.list = list; this.count = count; },
  clear() { this.reports = []; this.blocked = 0; this.received = null; this.duties.clear(); this.draw(); },

  take({ nodes: reports, blocked }) {
    this.reports = reports; this.blocked = blocked; this.received = performance.now();
    this.draw();
  },
  /** Publishers by topic. */
  note(publishers) {
    for (const topic of DUTIES) for (const name of publishers[topic] ?? []) {
      if (!this.duties.has(name)) this.duties.set(name, new Set());
      this.duties.get(name).add(topic);
    }
  },
  /** Seconds without a report of the live view itself; 0 while it responds. */
  get mute() {
    const age = this.received === null ? 0 : (performance.now() - this.received) / 1000;
    return age > MUTE_S ? age : 0;
  },
  stateOf(name) { return this.reports.find((report) => report.name === name)?.state; },

  /** Missing nodes, needed ones first; `hasStatus`: whether a node publishes a status. */
  missed(hasStatus) {
    const isNeeded = ({ name, state }) => {
      const duties = this.duties.get(name);
      // A node that only teleoperates may leave.
      const stays = duties && [...duties].some((topic) => state === "silent" || topic !== "/cmd_vel");
      return stays || hasStatus(name);
    };
    const bad = this.reports.filter(({ state }) => state === "silent" || state === "gone");
    return bad.map((report) => ({ ...report, needed: Boolean(isNeeded(report)) }))
      .filter(({ needed, state }) => needed || state === "silent")
      .sort((a, b) => b.needed - a.needed);
  },

  draw() {
    const rank = { silent: 0, gone: 1 };
    const sorted = [...this.reports].sort((a, b) => (rank[a.state] ?? 2) - (rank[b.state] ?? 2) || (a.name < b.name ? -1 : 1));
    const bad = sorted.filter(({ state }) => state in rank).length;
    const count = sorted.length - sorted.filter(({ state }) => state === "gone").length;
    this.count.textContent = count || bad ? String(count) : "";
    while (this.list.children.length > sorted.length) this.list.lastElementChild.remove();
    sorted.forEach((report, index) => {
      const item = this.list.children[index] ?? this.list.appendChild(this.item());
      const { name, state, since } = report;
      if (item.className !== state) item.className = state;
      const note = { silent: `no response for ${ageText(since)}`, gone: `gone for ${ageText(since)}`, unknown: "state unknown" }[state] ?? "";
      if (item.children[1].textContent !== name) item.children[1].textContent = name;
      if (item.children[2].textContent !== note) item.children[2].textContent = note;
      item.title = { alive: "responds", silent: "stopped, blocked or disconnected", gone: "ended or disconnected", unknown: "has no parameter services, so its state is unknown" }[state] ?? "";
    });
  },
  item() {
    const item = document.createElement("li");
    item.append(document.createElement("i"), document.createElement("code"), document.createElement("small"));
    return item;
  },
};

function ageText(seconds) {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
}

/** "Control", "Control and planner", "4 nodes". */
function namesText(reports) {
  const names = reports.map(({ name }) => name.slice(name.lastIndexOf("/") + 1).replaceAll("_", " "));
  const text = names.length > 3 ? `${names.length} nodes` : names.join(", ").replace(/, ([^,]*)$/, " and $1");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Headline and detail of missing nodes; null without a problem. */
function nodeProblem(reports) {
  if (!reports.length) return null;
  const states = new Set(reports.map(({ state }) => state)), many = reports.length > 1;
  const longest = ageText(Math.max(...reports.map(({ since }) => since)));
  if (states.size > 1) return [`${namesText(reports)} are missing`, `Gone or not responding for ${longest}.`];
  if (states.has("gone")) return [`${namesText(reports)} ${many ? "are" : "is"} gone`, `Ended or disconnected ${longest} ago.`];
  return [`${namesText(reports)} ${many ? "do" : "does"} not respond`, `Stopped, blocked or disconnected for ${longest}.`];
}
