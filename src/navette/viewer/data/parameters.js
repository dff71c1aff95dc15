// Parameters of every node, with a slider for each number: changed while the robot drives.
"use strict";

const parameters = {
  values: new Map(), // "/node.name" → { value, type }
  texts: new Map(),  // "/node.name" → { meaning, allowed, read_only, low, high, step }
  rows: new Map(),   // "/node.name" → { input, slider, refusal }
  node: null,        // as a person chose it; it may be gone for a while

  /** @param set called with the full name, the value and its wire type */
  start(select, table, set) {
    this.select = select; this.table = table; this.set = set;
    select.onchange = () => { this.node = select.value; this.list(); };
  },
  clear() { this.values.clear(); this.texts.clear(); this.list(); },

  take(list) {
    let isNew = false;
    for (const { name, value, type } of list) {
      if (value === undefined) { isNew = this.values.delete(name) || isNew; continue; }
      isNew = !this.values.has(name) || isNew;
      this.values.set(name, { value, type });
      if (!isNew) this.show(name);
    }
    if (isNew) this.list();
  },
  /** What parameters mean and which values they take. */
  describe(list) {
    for (const text of list) this.texts.set(text.name, text);
    if (list.some(({ name }) => this.rows.has(name)) && !this.table.contains(document.activeElement)) this.list();
  },

  list() {
    const names = [...this.values.keys()], nodes = [...new Set(names.map(nodeOf))].sort();
    this.node ??= nodes.find((name) => name === "/control") ?? null;
    const shown = this.node ?? nodes[0] ?? null;
    const options = nodes.map((name) => new Option(name, name, false, name === shown));
    if (shown !== null && !nodes.includes(shown)) options.push(new Option(`${shown} (gone)`, shown, true, true));
    this.select.replaceChildren(...options);
    this.select.hidden = options.length === 0;
    this.rows.clear();
    const own = names.filter((name) => nodeOf(name) === shown && !name.endsWith(".use_sim_time")).sort();
    this.table.replaceChildren(...own.map((name) => this.row(name, shown)));
  },

  row(name, node) {
    const { value } = this.values.get(name), text = this.texts.get(name) ?? {}, line = document.createElement("tr");
    line.title = [text.meaning, text.allowed && `Allowed: ${text.allowed}`, text.read_only && "Read only"].filter(Boolean).join("\n");
    line.insertCell().textContent = name.slice(node.length + 1);
    const choices = typeof value === "string" && /^one of (.+)/.exec(text.allowed ?? "")?.[1].split(", ");
    const input = document.createElement(choices ? "select" : "input"), cell = line.insertCell(), side = line.insertCell();
    const row = { input, refusal: Object.assign(document.createElement("p"), { className: "hint bad", hidden: true }) };
    input.setAttribute("aria-label", name);
    if (choices) input.append(...choices.map((choice) => new Option(choice)));
    else input.type = typeof value === "boolean" ? "checkbox" : "text";
    input.disabled = Boolean(text.read_only);
    input.onchange = () => this.send(name, input.type === "checkbox" ? input.checked : input.value);
    if (typeof value === "number") {
      row.slider = this.slider(name, text, input);
      cell.append(row.slider);
    }
    side.append(input, row.refusal);
    this.rows.set(name, row);
    this.show(name);
    return line;
  },

  /** Slider range: declared by the node, or from 0 to twice the value. */
  slider(name, { low, high, step, read_only }, input) {
    const { value } = this.values.get(name), whole = this.isWhole(name);
    const most = value === 0 ? 1 : 2 * Math.abs(value), has = Number.isFinite(low) && Number.isFinite(high);
    const [min, max] = has ? [low, high] : [value < 0 ? -most : 0, most];
    const slider = Object.assign(document.createElement("input"), {
      type: "range", min, max, step: step || (whole ? 1 : roundStep(max - min)), disabled: Boolean(read_only),
    });
    slider.setAttribute("aria-label", `${name}, slider`);
    slider.oninput = () => { input.value = this.text(Number(slider.value)); };
    slider.onchange = () => this.send(name, slider.value);
    return slider;
  },

  isWhole(name) {
    const { value, type } = this.values.get(name);
    return Number.isInteger(value) && type !== "float64";
  },
  text: (value) => typeof value === "number" ? String(Number(value.toPrecision(6))) : typeof value === "string" ? value : JSON.stringify(value),

  show(name) {
    const row = this.rows.get(name);
    if (!row || document.activeElement === row.slider) return;
    const { value } = this.values.get(name);
    if (typeof value === "boolean") row.input.checked = value;
    else if (document.activeElement !== row.input || row.input.tagName === "SELECT") row.input.value = this.text(value);
    if (row.slider) row.slider.value = value;
  },

  /** What was typed, as the kind of value that the parameter has. */
  send(name, typed) {
    const { value, type } = this.values.get(name), row = this.rows.get(name);
    let wanted = typed;
    row.refusal.hidden = true;
    if (typeof value === "number") {
      wanted = Number(String(typed).trim().replace(",", ".").replace("−", "-"));
      if (!Number.isFinite(wanted)) return this.refuse(name, `${typed} is no number`);
    } else if (typeof value === "object") {
      try { wanted = JSON.parse(typed); } catch { return this.refuse(name, "no list: [1, 2]"); }
    }
    this.set(name, wanted, type);
  },
  /** Why it was not set, beside it, and what it is instead; false where it is not shown. */
  refuse(name, reason) {
    const row = this.rows.get(name);
    if (!row) return false;
    row.refusal.textContent = reason.replace(/^parameter '[^']*': /, "");
    row.refusal.hidden = false;
    const { value } = this.values.get(name);
    if (typeof value === "boolean") row.input.checked = value; else row.input.value = this.text(value);
    if (row.slider) row.slider.value = value;
    return true;
  },
};
/** A 1, 2 or 5 and its zeros: some 100 to 250 steps over the span. */
function roundStep(span) {
  const least = span / 250, unit = 10 ** Math.floor(Math.log10(least));
  return Number(([1, 2, 5].find((digit) => digit * unit >= least) ?? 10) * unit).toPrecision(1);
}
const nodeOf = (name) => name.slice(0, name.indexOf("."));
