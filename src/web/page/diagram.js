// The timing diagram: bits as waves, values as curves, alarms as bars, scrolling with the machine. Its look is that of `--svg`.

import { body, button, el, field, say, seconds, set, svg } from "./dom.js";
import { bitOf, index, machine, message, on } from "./machine.js";

const KEY = "opennck diagram";
const ROW = 26;
const CURVE = 76;
/** The width for names beside the rows; on a phone names stand above them. */
const NAMES = 210;
const ABOVE = 14;
const TOP = 26;
const WINDOWS = [0.5, 1, 2, 5, 10, 30, 60];
const VALUES = ["position", "setpoint", "velocity", "following_error", "synchronism_difference", "slide"];
const LINES = 14;

let picked = [];
let frame;
let log;
let chips;
let span = 10;
/** The time at the right end; null while the diagram follows the machine. */
let end = null;
let scroll;
let follow;
/** The left end of the waves. */
let left = NAMES;

export function chosen(name) {
  return picked.includes(name);
}

/** Takes a signal or a value into the diagram, or out of it. */
export function choose(name, isChosen) {
  picked = picked.filter((other) => other !== name);
  if (isChosen) picked.push(name);
  try {
    localStorage.setItem(KEY, JSON.stringify(picked));
  } catch { /* without storage, the choice lasts as long as the page */ }
  list();
  draw();
}

/** The axis and the column of a value of an axis. */
function axisValue(name) {
  const [owner, what] = name.split(".");
  const axis = machine.catalogue.axes.findIndex((axis) => axis.name === owner);
  const column = VALUES.indexOf(what);
  return axis >= 0 && column >= 0 ? [axis, column] : null;
}

/** A bit of inputs, outputs or flags. */
function isMemory(name) {
  return /^[IQM]\d{1,5}\.[0-7]$/.test(name);
}

function isKnown(name) {
  return index(name) !== undefined || axisValue(name) !== null || isMemory(name);
}

/** The number of letters to insert, remove or change to make one text the other. */
function distance(one, other) {
  let row = Array.from({ length: other.length + 1 }, (_, at) => at);
  for (let at = 0; at < one.length; at += 1) {
    const next = [at + 1];
    for (let to = 0; to < other.length; to += 1) {
      next.push(Math.min(next[to] + 1, row[to + 1] + 1, row[to] + (one[at] === other[to] ? 0 : 1)));
    }
    row = next;
  }
  return row.at(-1);
}

/** The known name that is most like another one; null if none is. */
function nearest(name, names) {
  const [near, apart] = names.reduce((best, known) => {
    const apart = distance(name.toLowerCase(), known.toLowerCase());
    return apart < best[1] ? [known, apart] : best;
  }, [null, Infinity]);
  return apart <= Math.max(2, name.length / 3) ? near : null;
}

function first() {
  const [axis] = machine.catalogue.axes;
  const names = ["mode_group_1.active_machine_function_ref", ...[
    "traversing_key_plus", "traverse_command_plus", "position_controller_active", "referenced_synchronized_1", "homed", "error",
    "gantry_synchronization_ready_to_start", "gantry_grouping_is_synchronized", "gantry_coupled", "position", "velocity",
  ].map((name) => `${axis?.name}.${name}`)];
  return names.filter((name) => index(name) !== undefined || axisValue(name));
}

function list() {
  chips.replaceChildren(...picked.map((name) =>
    el("li", {}, button(`${name} ×`, () => choose(name, false), { "aria-label": `Remove ${name}` }))));
}

function colour(by) {
  if (by === "nck") return "nck";
  if (by === "plant") return "plant";
  return by ? "plc" : "still";
}

/** Where a signal changes in a window: its value before, and its edges. */
function course(at, from, to) {
  let before;
  const edges = [];
  const isOther = typeof at === "string";
  for (const edge of machine.edges) {
    if ((isOther ? edge.a : edge.i) !== at) continue;
    if (edge.t < from) before = edge.v;
    else if (edge.t <= to) edges.push(edge);
  }
  if (before === undefined && isOther) before = edges.length ? 1 - edges[0].v : bitOf(at);
  if (before === undefined) {
    before = edges.length && machine.catalogue.signals[at].bits === 1 ? 1 - edges[0].v : edges.length ? null : machine.values[at];
  }
  return { before, edges };
}

function bit(group, at, y, x, from, to) {
  const { before, edges } = course(at, from, to);
  const level = (value) => y + (value ? 6 : ROW - 7);
  let path = `M${left} ${level(before)}`;
  const by = edges.findLast(({ by }) => by !== "power on")?.by ?? machine.writers.get(at)?.[1];
  for (const { t, v } of edges) path += `H${x(t).toFixed(1)}V${level(v)}`;
  group.append(svg("path", { class: `wave ${colour(by)}`, d: `${path}H${x(to).toFixed(1)}` }));
  for (const { t, v, by, why } of edges) {
    const touch = svg("rect", { class: "touch", x: x(t) - 4, y, width: 8, height: ROW });
    touch.append(svg("title", {}, `${seconds(t)} ${v ? "0 → 1" : "1 → 0"} ${by}${why ? `\n${why}` : ""}`));
    group.append(touch);
  }
}

function number(group, at, y, x, from, to) {
  const { before, edges } = course(at, from, to);
  let start = left;
  let value = before;
  for (const edge of [...edges, { t: to, v: null }]) {
    const right = x(edge.t);
    group.append(svg("rect", { class: "lane", x: start, y: y + 5, width: Math.max(right - start, 0.5), height: ROW - 10 }));
    if (right - start > 24 && value !== null) group.append(svg("text", { class: "small", x: start + 4, y: y + ROW / 2 + 4 }, `${value}`));
    [start, value] = [right, edge.v];
  }
}

function curve(group, [axis, column], y, x, from, to) {
  const samples = machine.samples.filter(([time]) => time >= from - 0.2 && time <= to);
  if (samples.length < 1) return;
  const values = samples.map(([, axes]) => axes[axis][column]);
  let [low, high] = [Math.min(...values), Math.max(...values)];
  // What only trembles is a line.
  const least = Math.max(Math.abs(high), Math.abs(low)) * 0.002;
  if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
  const height = (value) => y + CURVE - 12 - (high > low ? (value - low) / (high - low) : 0.5) * (CURVE - 24);
  if (low < 0 && high > 0) group.append(svg("path", { class: "zero", d: `M${left} ${height(0)}H${x(to)}` }));
  const points = samples.map(([time], at) => `${Math.max(x(time), left).toFixed(1)} ${height(values[at]).toFixed(1)}`);
  group.append(svg("path", { class: "wave value", d: `M${points.join("L")}H${x(to).toFixed(1)}` }));
  const beside = left < NAMES ? { class: "small", x: left + 2 } : { class: "small right", x: left - 8 };
  group.append(svg("text", { ...beside, y: y + 18 }, high.toFixed(3)), svg("text", { ...beside, y: y + CURVE - 4 }, low.toFixed(3)));
}

function alarms(group, y, x, from, to) {
  const open = new Map();
  const bar = (name, since, until) => {
    const [start, right] = [Math.max(x(since), left), Math.min(x(until), x(to))];
    if (right <= left || start > x(to)) return;
    const shown = svg("g");
    shown.append(svg("title", {}, `${name}\n${seconds(since)}`),
      svg("rect", { class: "alarm", x: start, y: y + 5, width: Math.max(right - start, 2), height: ROW - 10 }));
    if (right - start > 40) shown.append(svg("text", { class: "alarm-text", x: start + 4, y: y + ROW / 2 + 4 }, name.split(" ")[0]));
    group.append(shown);
  };
  for (const { t, a, v, kind } of machine.edges) {
    if (kind !== "alarm" || t > to) continue;
    if (v) open.set(a, t);
    else {
      bar(a, open.get(a) ?? from, t);
      open.delete(a);
    }
  }
  for (const [name, since] of open) bar(name, since, to);
}

/** The bits of memory in the diagram as they were last. */
const memory = new Map();

/** The server tells no changes of memory bits: they are compared with each event, 30 a second. */
function compareMemory({ now }) {
  for (const name of picked.filter((one) => isMemory(one))) {
    const is = bitOf(name);
    if (memory.has(name) && memory.get(name) !== is) machine.edges.push({ t: now.time, a: name, v: is });
    memory.set(name, is);
  }
}

export function draw() {
  if (!frame || !machine.now || document.body.dataset.view !== "Diagram") return;
  const to = end ?? machine.now.time;
  const from = to - span;
  const width = Math.max(frame.clientWidth, 300);
  const isNarrow = width < 560;
  left = isNarrow ? 4 : NAMES;
  const x = (time) => left + ((time - from) / span) * (width - left - 10);
  const drawing = svg("svg", { class: "diagram", width, role: "img", "aria-label": `Timing diagram of ${picked.length} signals, ${seconds(Math.max(from, 0))} to ${seconds(to)}` });
  const grid = 10 ** Math.floor(Math.log10(span / 4));
  const each = [1, 2, 5, 10].map((factor) => factor * grid).find((step) => span / step <= (width - left) / 70) ?? span;
  let y = TOP;
  const rows = svg("g");
  const name = (text, height) => {
    if (isNarrow) {
      rows.append(svg("text", { x: 4, y: y + 11 }, text));
      y += ABOVE;
      return;
    }
    rows.append(svg("text", { x: 4, y: y + Math.min(height, 30) / 2 + 4 }, text.length > 30 ? `…${text.slice(-28)}` : text));
  };
  for (const one of picked) {
    const at = index(one);
    const value = axisValue(one);
    const height = value ? CURVE : ROW;
    name(one, height);
    if (value) curve(rows, value, y, x, from, to);
    else if (isMemory(one)) bit(rows, one, y, x, from, to);
    else if (at !== undefined && machine.catalogue.signals[at].bits === 1) bit(rows, at, y, x, from, to);
    else if (at !== undefined) number(rows, at, y, x, from, to);
    y += height;
  }
  name("alarms", ROW);
  alarms(rows, y, x, from, to);
  y += ROW;
  for (let time = Math.ceil(from / each) * each; time <= to; time += each) {
    if (time < -1e-9) continue;
    drawing.append(svg("path", { class: "grid", d: `M${x(time).toFixed(1)} ${TOP - 6}V${y}` }),
      svg("text", { class: "small", x: x(time), y: 14, "text-anchor": "middle" }, `${Number(time.toFixed(6))} s`));
  }
  for (const { t, a } of machine.edges.filter(({ kind, t }) => (kind === "note" || kind === "event") && t >= from && t <= to)) {
    const pole = svg("path", { class: "pole", d: `M${x(t).toFixed(1)} ${TOP - 6}V${y}` });
    pole.append(svg("title", {}, `${seconds(t)} ${a}`));
    drawing.append(pole);
  }
  drawing.append(rows);
  set(drawing, "height", String(y + 6));
  frame.replaceChildren(drawing);
  edges(to);
}

/** The same as text: the last edges of the chosen signals. */
function edges(to) {
  const wanted = new Set(picked.map(index).filter((at) => at !== undefined));
  const found = [];
  for (let at = machine.edges.length - 1; at >= 0 && found.length < LINES; at -= 1) {
    const edge = machine.edges[at];
    if (edge.t <= to && (wanted.has(edge.i) || edge.kind || (edge.a !== undefined && picked.includes(edge.a)))) found.push(edge);
  }
  const lines = found.map(({ t, i, a, v, by, why, kind }) => {
    const change = kind === "alarm" ? (v ? "alarm " : "cancelled: ") : "";
    const what = i === undefined ? change + a + (kind || v === undefined ? "" : ` = ${v}`) : `${machine.catalogue.signals[i].symbol} = ${v}`;
    return `${seconds(t)}  ${what}${by ? `  ${by}` : ""}${why ? `  ${why}` : ""}`;
  });
  if (log.dataset.shown === lines.join("\n")) return;
  log.dataset.shown = lines.join("\n");
  log.replaceChildren(...lines.map((line) => el("li", {}, line)));
}

export function begin() {
  try {
    picked = JSON.parse(localStorage.getItem(KEY)) ?? [];
  } catch {
    picked = [];
  }
  picked = picked.filter(isKnown);
  if (!picked.length) picked = first();
  const names = [...machine.catalogue.axes.flatMap(({ name }) => VALUES.map((value) => `${name}.${value}`)),
    ...machine.catalogue.signals.map(({ symbol }) => symbol)];
  const add = el("input", { type: "text", list: "plots", autocomplete: "off", placeholder: "X.position" });
  const take = () => {
    const name = add.value.trim();
    if (!name) return;
    if (!isKnown(name)) {
      const near = nearest(name, names);
      message(`expected a signal, a value of an axis or a bit such as M10.0, found ${name}${near ? `: did you mean ${near}?` : ""}`, true);
      return;
    }
    message("");
    choose(name, true);
    add.value = "";
  };
  const window = el("select", { change: () => { span = Number(window.value); draw(); } },
    ...WINDOWS.map((time) => el("option", { value: time, selected: time === span }, `${time} s`)));
  follow = button("Hold", () => {
    end = end === null ? machine.now.time : null;
    update();
  });
  scroll = el("input", { type: "range", min: 0, step: "any", input: () => { end = Number(scroll.value); update(); } });
  const update = () => {
    say(follow, end === null ? "Hold" : "Follow");
    draw();
  };
  chips = el("ul", { class: "chips", "aria-label": "Signals in the diagram" });
  frame = el("div", { class: "frame" });
  log = el("ol", { class: "log", "aria-label": "Last edges" });
  body("diagram").append(
    el("div", { class: "row" },
      el("form", { class: "row", submit: (event) => { event.preventDefault(); take(); } }, field("Signal or value", add), button("Add", take)),
      field("Window", window), follow, field("End", scroll)),
    el("datalist", { id: "plots" }, ...names.map((name) => el("option", { value: name }))),
    chips, frame, el("h3", {}, "Last edges"), log);
  list();
  let drawnAt = 0;
  on("snapshot", () => memory.clear());
  on("step", compareMemory);
  on("step", ({ now }) => {
    set(scroll, "max", String(now.time));
    if (end === null) scroll.value = now.time;
    else end = Math.min(end, now.time);
    const time = performance.now();
    if (end === null && time - drawnAt > 90) {
      drawnAt = time;
      draw();
    }
  });
  addEventListener("resize", draw);
}
