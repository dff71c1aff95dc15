// Parameters of every node, with a slider for each number: changed while the robot drives.
"use strict";

const parameters = {
  values: new Map(), // "/node.name" → { value, type }
  rows: new Map(),   // "/node.name" → { input, slider }
  node: null,

  /** @param set called with the full name, the value and its wire type */
  start(select, table, set) {
    this.select = select; this.table = table; this.set = set;
    select.onchange = () => { this.node = select.value; this.list(); };
  },
  clear() { this.values.clear(); this.list(); },

  take(list) {
    let isNew = false;
    for (const { name, value, type } of list) {
      if (value === undefined) { isNew ||= this.values.delete(name); continue; }
      isNew ||= !this.values.has(name);
      this.values.set(name, { value, type });
      if (!isNew) this.show(name);
    }
    if (isNew) this.list();
  },

  list() {
    const nodes = [...new Set([...this.values.keys()].map((name) => name.slice(0, name.indexOf("."))))].sort();
    if (!nodes.includes(this.node)) this.node = nodes.find((name) => name === "/control") ?? nodes[0] ?? null;
    this.select.replaceChildren(...nodes.map((name) => new Option(name, name, false, name === this.node)));
    const names = [...this.values.keys()].filter((name) => name.startsWith(`${this.node}.`) && !name.endsWith(".use_sim_time")).sort();
    this.rows.clear();
    this.table.replaceChildren(...names.map((name) => this.row(name)));
  },

  row(name) {
    const { value } = this.values.get(name), line = document.createElement("tr");
    line.insertCell().textContent = name.slice(this.node.length + 1);
    const input = document.createElement("input"), cell = line.insertCell(), side = line.insertCell();
    const row = { input };
    input.setAttribute("aria-label", name);
    input.type = typeof value === "boolean" ? "checkbox" : "text";
    input.onchange = () => this.send(name, input.type === "checkbox" ? input.checked : input.value);
    if (typeof value === "number") {
      const most = value === 0 ? 1 : 2 * Math.abs(value), whole = this.isWhole(name);
      row.slider = Object.assign(document.createElement("input"), {
        type: "range", min: value < 0 ? -most : 0, max: most, step: whole ? 1 : most / 200,
      });
      row.slider.setAttribute("aria-label", `${name}, slider`);
      row.slider.oninput = () => { input.value = this.text(Number(row.slider.value)); };
      row.slider.onchange = () => this.send(name, row.slider.value);
      cell.append(row.slider);
    }
    side.append(input);
    this.rows.set(name, row);
    this.show(name);
    return line;
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
    else if (document.activeElement !== row.input) row.input.value = this.text(value);
    if (row.slider) row.slider.value = value;
  },

  /** What was typed, as the kind of value that the parameter has. */
  send(name, typed) {
    const { value, type } = this.values.get(name);
    let wanted = typed;
    if (typeof value === "number") {
      wanted = Number(String(typed).trim().replace(",", ".").replace("−", "-"));
      if (!Number.isFinite(wanted)) return this.show(name);
    } else if (typeof value === "object") {
      try { wanted = JSON.parse(typed); } catch { return this.show(name); }
    }
    this.set(name, wanted, type);
  },
};
