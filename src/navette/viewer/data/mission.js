// The goal of any node, refused goals, contacts, and the behaviour tree that runs.
"use strict";

const SAME_GOAL_M = 0.06;  // the status gives three decimals, the page sends more

const STATUSES = { "*": "running", "✓": "succeeded", "✕": "failed", "-": "idle" };
const STATUS_SIGNS = { running: "●", succeeded: "✓", failed: "✕", idle: "○" };
const TREE_KINDS = { "{-}": "sequence", "[-]": "sequence", "{o}": "fallback", "[o]": "fallback", "/_/": "parallel", "-^-": "decorator" };

const mission = {
  goal: null,       // newest goal on a topic, [x, y]
  sent: null,       // goal sent from this page, until the planner has reported on it
  contacts: 0,
  reported: "",     // goal_id of the planner's last report on a goal of this page

  start(parts) { this.parts = parts; },
  leave() { this.goal = this.sent = null; this.contacts = 0; this.parts.card.hidden = true; },
  /** geometry_msgs PointStamped or PoseStamped: both begin with header, x, y. */
  readGoal(reader) { reader.header(); this.goal = [reader.f64(), reader.f64()]; },
  cancel() { this.goal = this.sent = null; },
  readContacts({ values }) { this.contacts = Number(values.count) || this.contacts + 1; },
  readTree(reader) {
    this.parts.card.hidden = false;
    const lines = reader.text().split("\n").map((line) => {
      const row = document.createElement("li"), node = treeNode(line);
      if (!node) { row.textContent = line; return row; }
      row.className = node.status;
      row.style.paddingLeft = `${1.35 * node.depth}rem`;
      const parts = [["i", STATUS_SIGNS[node.status]], ["span", node.name], ["small", node.note]];
      row.append(...parts.map(([tag, text]) => Object.assign(document.createElement(tag), { textContent: text })));
      row.firstChild.ariaLabel = node.status;
      return row;
    });
    this.parts.tree.replaceChildren(...lines);
  },
  /** The planner's goal, else that of the topics: a planner of the user has no status. */
  shown(planner) {
    if (planner?.message === "canceled") return this.sent;  // the next one, if any
    const own = [parseFloat(planner?.values.goal_x), parseFloat(planner?.values.goal_y)];
    return own.every(Number.isFinite) ? own : this.goal;
  },
  /** Why the goal of this page was refused; null while that is not known, or it was not. */
  refusal(planner) {
    if (!this.sent || !planner) return null;
    const [x, y] = [Number(planner.values.goal_x), Number(planner.values.goal_y)];
    const isThis = Math.hypot(x - this.sent[0], y - this.sent[1]) <= SAME_GOAL_M;
    if (!isThis || planner.values.goal_id === this.reported) return null;
    const { result } = planner.values;
    if (!result && planner.message !== "following") return null;
    this.reported = planner.values.goal_id;
    this.sent = null;
    return result && result !== "reached" && result !== "canceled" ? result : null;
  },
};

/** "    {o} Ladder [*] -- note" → depth, status, name and note; null for other text. */
function treeNode(line) {
  const found = /^( *)(\S+) (.*) \[([*✓✕-])\](?: -- (.*))?$/u.exec(line);
  if (!found) return null;
  const [, indent, sign, name, mark, message] = found;
  const note = [TREE_KINDS[sign], message].filter(Boolean).join(" · ");
  return { depth: indent.length / 4, status: STATUSES[mark], name, note };
}
