// The signals of the interface by data block, with search, filters and who wrote them last.

import { body, button, el, field, say, seconds, set } from "./dom.js";
import { command, machine, on } from "./machine.js";
import { ask } from "./why.js";
import { chosen, choose } from "./diagram.js";

const ROWS = 150;
const WRITERS = { plc: "PLC", nck: "NCK", hmi: "HMI" };
/** How long a changed row is marked. */
const MARKED = 900;

/** A number that a person typed as JSON: numbers as numbers, texts such as 100% as texts. */
function typed(text) {
  const number = Number(text);
  return text.trim() !== "" && Number.isFinite(number) ? number : text;
}

function writer() {
  const list = el("datalist", { id: "writable" },
    ...machine.catalogue.signals.filter(({ writer }) => writer !== "nck").map(({ symbol }) => el("option", { value: symbol })));
  const place = el("input", { type: "text", list: "writable", autocomplete: "off", placeholder: "X.traversing_key_plus or M10.3" });
  const value = el("input", { type: "text", value: "1", class: "short" });
  const send = (verb) => () => {
    const name = place.value.trim();
    if (name) command(verb === "release" ? { release: [name] } : { [verb]: { [name]: typed(value.value) } });
  };
  return el("form", { class: "row writes", "aria-label": "Write a signal", submit: (event) => { event.preventDefault(); send("set")(); } },
    list, field("Signal or address", place), field("Value", value),
    button("Set", send("set")), button("Force", send("force")), button("Release", send("release")));
}

export function begin() {
  const place = body("signals");
  const { signals } = machine.catalogue;
  const search = el("input", { type: "search", autocomplete: "off", placeholder: "referenced, DB31.DBX4, enable…" });
  const blocks = [...new Set(signals.map(({ address }) => address.split(".")[0]))];
  const block = el("select", {}, el("option", { value: "" }, "all"), ...blocks.map((name) => {
    const owner = signals.find(({ address }) => address.startsWith(`${name}.`)).symbol.split(".")[0];
    return el("option", { value: name }, `${name} ${owner}`);
  }));
  const writtenBy = el("select", {}, el("option", { value: "" }, "all"),
    ...Object.entries(WRITERS).map(([key, name]) => el("option", { value: key }, name)));
  const only = el("input", { type: "checkbox" });
  const count = el("p", { class: "hint", role: "status" });
  const rows = el("tbody");
  place.append(
    el("div", { class: "row", role: "search" }, field("Search", search), field("Block", block), field("Signal of", writtenBy),
      el("label", { class: "check" }, only, " that changed")),
    writer(), count,
    el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Signals, table" },
      el("table", { class: "signals" },
        el("thead", {}, el("tr", {}, ...["Address", "Symbol", "Value", "Of", "Last written", "Actions"].map((head) =>
          el("th", { scope: "col" }, head)))),
        rows)));

  let shown = new Map();
  const row = (at) => {
    const signal = signals[at];
    const value = el("td", { class: "value" });
    const last = el("td", { class: "last" });
    const plot = el("button", { type: "button", click: () => choose(signal.symbol, !chosen(signal.symbol)) }, "Plot");
    const isBit = signal.bits === 1;
    const name = (action) => ({ "aria-label": `${action} ${signal.symbol}` });
    plot.setAttribute("aria-label", `Plot ${signal.symbol}`);
    const actions = signal.writer === "nck"
      ? [isBit ? button("Why not?", () => ask(signal.symbol), name("Why not")) : null]
      : isBit ? [1, 0].map((bit) => button(`${bit}`, () => command({ set: { [signal.symbol]: bit } }), { ...name(`Set to ${bit}`), class: "write" })) : [];
    const element = el("tr", {}, el("td", { class: "address" }, signal.address), el("th", { scope: "row", title: signal.doc }, signal.symbol),
      value, el("td", { class: "of" }, WRITERS[signal.writer]), last, el("td", { class: "actions" }, ...actions, plot));
    return { element, value, last, plot, before: undefined, marked: 0 };
  };
  const list = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = [];
    signals.forEach((signal, at) => {
      if (block.value && !signal.address.startsWith(`${block.value}.`)) return;
      if (writtenBy.value && signal.writer !== writtenBy.value) return;
      if (only.checked && !machine.writers.has(at)) return;
      const text = `${signal.address} ${signal.symbol} ${signal.doc}`.toLowerCase();
      if (words.every((word) => text.includes(word))) found.push(at);
    });
    say(count, found.length > ROWS ? `${found.length} signals, the first ${ROWS} are shown` : `${found.length} signals`);
    const before = shown;
    shown = new Map(found.slice(0, ROWS).map((at) => [at, before.get(at) ?? row(at)]));
    rows.replaceChildren(...[...shown.values()].map(({ element }) => element));
    update();
  };
  const update = () => {
    if (document.body.dataset.view !== "Signals") return;
    const now = performance.now();
    for (const [at, entry] of shown) {
      const value = machine.values[at];
      if (entry.before !== undefined && entry.before !== value) entry.marked = now;
      entry.before = value;
      say(entry.value, Number.isInteger(value) ? `${value}` : value?.toPrecision(7) ?? "");
      set(entry.value, "data-on", String(value !== 0));
      entry.element.classList.toggle("changed", entry.marked > 0 && now - entry.marked < MARKED);
      const [time, by, why] = machine.writers.get(at) ?? [];
      say(entry.last, by ? `${by} at ${seconds(time)}${why ? `: ${why}` : ""}` : "-");
      set(entry.plot, "aria-pressed", String(chosen(signals[at].symbol)));
    }
  };
  for (const control of [search, block, writtenBy, only]) control.addEventListener("input", list);
  on("snapshot", list);
  on("step", ({ edges }) => {
    if (only.checked && edges?.some(({ i }) => i !== undefined && !shown.has(i))) list();
    else update();
  });
  addEventListener("hashchange", update);
}
