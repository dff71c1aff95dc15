// How the nodes are: the live view asks those of other programs twice a second and tells us.
"use strict";

// Nobody drives without these: a node that says one of them is missed at once.
const DUTIES = ["/cmd_vel", "/path", "/map", "/costmap", "/odom/filtered", "/odom", "/lidar", "/scan"];
const MUTE_S = 2.5; // reports come every half second

const nodes = {
  reports: [],
  hangs: 0,            // s that the program of the live view has not come to its nodes
  told: null,          // when the last report came, by this machine's clock
  duties: new Map(),   // node → the topics it is needed for, also when it is gone

  start(list, count) { this.list = list; this.count = count; },
  clear() { this.reports = []; this.hangs = 0; this.told = null; this.duties.clear(); this.draw(); },

  take({ nodes: reports, hangs }) {
    this.reports = reports; this.hangs = hangs; this.told = performance.now();
    this.draw();
  },
  /** Who publishes: topic → names. */
  note(publishers) {
    for (const topic of DUTIES) for (const name of publishers[topic] ?? []) {
      if (!this.duties.has(name)) this.duties.set(name, new Set());
      this.duties.get(name).add(topic);
    }
  },
  /** Seconds without a word from the live view itself; 0 while all is well. */
  get mute() {
    const age = this.told === null ? 0 : (performance.now() - this.told) / 1000;
    return age > MUTE_S ? age : 0;
  },
  stateOf(name) { return this.reports.find((report) => report.name === name)?.state; },

  /** Nodes that are missed, the needed ones first; `hasStatus`: whether one tells how it is. */
  missed(hasStatus) {
    const isNeeded = ({ name, state }) => {
      const duties = this.duties.get(name);
      // Whoever drives by hand may go as he came.
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
      const note = { silent: `no answer for ${ageText(since)}`, gone: `gone for ${ageText(since)}`, unknown: "cannot be asked" }[state] ?? "";
      if (item.children[1].textContent !== name) item.children[1].textContent = name;
      if (item.children[2].textContent !== note) item.children[2].textContent = note;
      item.title = { alive: "answers", silent: "frozen, hung or cut off", gone: "has ended, or is cut off", unknown: "has no parameter services: nobody can tell how it is" }[state] ?? "";
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

/** What is the matter with the nodes, for the headline; null while nothing is. */
function nodeTrouble(reports) {
  if (!reports.length) return null;
  const states = new Set(reports.map(({ state }) => state)), many = reports.length > 1;
  const longest = ageText(Math.max(...reports.map(({ since }) => since)));
  if (states.size > 1) return [`${namesText(reports)} are missing`, `Gone or without an answer, for ${longest}.`];
  if (states.has("gone")) return [`${namesText(reports)} ${many ? "are" : "is"} gone`, `Ended or cut off, ${longest} ago.`];
  return [`${namesText(reports)} ${many ? "do" : "does"} not answer`, `Frozen, hung or cut off, for ${longest}.`];
}
