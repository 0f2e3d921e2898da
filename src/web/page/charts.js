// The flowcharts of the control with the phase in which a part is now, the ways out of it, and what they wait for.

import { body, el, field, say, svg } from "./dom.js";
import { machine, on } from "./machine.js";
import { conditions, entry, summary } from "./why.js";

const WIDTH = 270;
const HEIGHT = 36;
const APART = 66;
const LANE = 15;

let choice = 0;
let drawn = "";

/** Edges of equal ends are one arrow. */
function arrows(chart) {
  const all = new Map();
  for (const { from, to, rule, text } of chart.edges) {
    if (!from || from === to) continue;
    const key = `${from} ${to}`;
    const arrow = all.get(key) ?? { from, to, rules: [], texts: [] };
    if (!arrow.rules.includes(rule)) arrow.rules.push(rule);
    arrow.texts.push(`${rule}: ${text}`);
    all.set(key, arrow);
  }
  return [...all.values()];
}

/** The lane of each arrow beside the boxes: arrows whose rows overlap have different lanes, short ones the inner ones. */
function lanes(list) {
  const taken = [];
  const length = ({ first, last }) => last - first;
  for (const arrow of [...list].sort((one, other) => length(one) - length(other))) {
    let lane = 0;
    while (taken.some((other) => other.lane === lane && other.first < arrow.last + 0.5 && arrow.first < other.last + 0.5)) lane += 1;
    arrow.lane = lane;
    taken.push(arrow);
  }
  return Math.max(0, ...taken.map(({ lane }) => lane + 1));
}

function picture(chart, phase) {
  const row = new Map(chart.phases.map(([id], at) => [id, at]));
  const list = arrows(chart);
  const beside = list.filter(({ from, to }) => row.get(to) !== row.get(from) + 1);
  for (const arrow of beside) {
    const ends = [row.get(arrow.from), row.get(arrow.to)];
    [arrow.first, arrow.last] = [Math.min(...ends), Math.max(...ends)];
  }
  const width = WIDTH + 30 + LANE * lanes(beside);
  const height = chart.phases.length * APART - (APART - HEIGHT) + 20;
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img", "aria-label": `${chart.title}, flowchart` });
  drawing.setAttribute("width", width);
  drawing.setAttribute("height", height);
  const head = svg("marker", { id: "head", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 9, markerHeight: 9, markerUnits: "userSpaceOnUse", orient: "auto" });
  head.append(svg("path", { d: "M0 0L8 4L0 8z" }));
  const defs = svg("defs");
  defs.append(head);
  drawing.append(defs);
  const above = [];
  const top = (id) => 10 + row.get(id) * APART;
  for (const { from, to, rules, texts, lane } of list) {
    const isNext = lane === undefined;
    const side = WIDTH + 14 + LANE * (lane ?? 0);
    const [start, end] = [top(from) + HEIGHT * 0.68, top(to) + HEIGHT * 0.32];
    const path = isNext ? `M${WIDTH / 2} ${top(from) + HEIGHT}V${top(to)}` : `M${WIDTH} ${start}H${side}V${end}H${WIDTH}`;
    const isNow = from === phase;
    const group = svg("g", { class: isNow ? "arrow now" : "arrow" });
    group.append(svg("title", {}, texts.join("\n")), svg("path", { d: path, "marker-end": "url(#head)" }));
    const label = rules.length > 2 ? `${rules[0]} +${rules.length - 1}` : rules.join(", ");
    const middle = (start + end) / 2;
    // The others have a tooltip: twenty texts beside each other are none.
    if (isNext || isNow) group.append(isNext
      ? svg("text", { x: WIDTH / 2 + 8, y: top(from) + HEIGHT + (APART - HEIGHT) / 2 + 3 }, label)
      : svg("text", { x: side + 10, y: middle, transform: `rotate(90 ${side + 10} ${middle})`, "text-anchor": "middle", dy: 4 }, label));
    // What is possible now lies above what is not.
    if (isNow) above.push(group);
    else drawing.append(group);
  }
  drawing.append(...above);
  for (const [id, text] of chart.phases) {
    const box = svg("g", { class: id === phase ? "phase now" : "phase" });
    const said = text.length > 46 ? `${text.slice(0, 44)}…` : text;
    box.append(svg("title", {}, text), svg("rect", { x: 1, y: top(id), width: WIDTH - 1, height: HEIGHT, rx: 5 }),
      svg("text", { x: WIDTH / 2, y: top(id) + HEIGHT / 2 + 4, "text-anchor": "middle" }, said));
    drawing.append(box);
  }
  return drawing;
}

export function begin() {
  const place = body("charts");
  const part = el("select", { change: () => { choice = Number(part.value); drawn = ""; show(); } });
  const phase = el("p", { class: "phase-now", role: "status" });
  const ways = el("ul");
  const waits = el("div");
  const frame = el("div", { class: "frame" });
  place.append(field("Part", part), phase,
    el("div", { class: "beside" }, frame,
      el("div", {}, el("h3", {}, "From here"), ways, el("h3", {}, "It waits for"), waits)));
  let aim = "";
  let parts = "";

  const show = () => {
    const { positions } = machine.now;
    const names = positions.map(({ chart, axes }) => {
      const { title } = machine.catalogue.charts.find(({ name }) => name === chart);
      return `${title}: ${axes.join(", ")}`;
    });
    if (parts !== names.join("\n")) {
      parts = names.join("\n");
      part.replaceChildren(...names.map((name, at) => el("option", { value: at }, name)));
      choice = Math.min(choice, Math.max(0, names.length - 1));
      part.value = String(choice);
    }
    const now = positions[choice];
    if (!now) {
      say(phase, "The control has no flowchart with a phase now.");
      return;
    }
    const chart = machine.catalogue.charts.find(({ name }) => name === now.chart);
    const text = chart.phases.find(([id]) => id === now.phase)?.[1] ?? now.phase;
    say(phase, `Now: ${text}`);
    ({ aim } = now);
    const key = `${choice} ${now.phase} ${parts}`;
    if (key === drawn) return;
    drawn = key;
    frame.replaceChildren(picture(chart, now.phase));
    const out = chart.edges.filter(({ from }) => from === now.phase || from === null);
    const name = (id) => chart.phases.find(([phase]) => phase === id)?.[1] ?? id;
    ways.replaceChildren(...out.map(({ rule, text, to }) => el("li", {}, `${rule}: ${text}: to “${name(to)}”`)));
    wait();
  };

  let told = "";
  const wait = async () => {
    if (!aim || document.hidden || document.body.dataset.view !== "Flowchart") return;
    const tree = await conditions(aim, 1);
    const text = JSON.stringify(tree);
    if (text === told) return;
    told = text;
    if (!tree || tree.error) waits.replaceChildren(el("p", {}, "The control does not say."));
    else if (tree.holds) waits.replaceChildren(el("p", {}, `Nothing: ${tree.what} is 1.`));
    else {
      const isOpen = waits.querySelector("details")?.open ?? false;
      waits.replaceChildren(...summary(tree),
        el("details", { ".open": isOpen }, el("summary", {}, "All conditions"), el("ul", { class: "tree" }, entry(tree))));
    }
  };
  setInterval(wait, 700);
  on("step", show);
  addEventListener("hashchange", wait);
}
