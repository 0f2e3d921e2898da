// Why a signal does not have another value: the conditions that the control tests, with what it finds and who wrote it.

import { body, button, el, field, say, seconds } from "./dom.js";
import { machine, message, on } from "./machine.js";

let asked = null;
let shown = "";
let tree;
let input;

/** The ends of a tree that are listed. */
const LEAST = 6;

let showsAll = false;

/** The parts of a condition that are shown: groups in groups of the same kind are one group. */
function shownParts({ parts = [] }) {
  return parts.flatMap((part) => {
    if (part.holds && !showsAll) return [];
    return part.what === "all of" && part.found === undefined ? shownParts(part) : [part];
  });
}

/** A condition as an entry of a list. */
export function entry(node) {
  const parts = shownParts(node).map(entry);
  return el("li", {}, el("span", { class: node.holds ? "mark holds" : "mark open" }, node.holds ? "holds" : "open"), ` ${said(node)}`,
    parts.length ? el("ul", { class: "tree" }, ...parts) : null);
}

/** A condition in words: what is tested, what is found and wanted, who wrote it. */
function said(node) {
  const value = node.found === undefined ? "" : node.holds ? ` = ${node.found}` : ` = ${node.found}, wanted ${node.wanted}`;
  const written = node.written ? `, written by ${node.written[1]} at ${seconds(node.written[0])}` : "";
  const side = node.writer && !node.holds && !node.parts?.length ? `: ${node.writer} signal${written}` : "";
  return `${node.what}${node.address && node.address !== node.what ? ` (${node.address})` : ""}${value}${side}`;
}

/** What is open at the ends of a tree: the signals and facts that hold up everything else. */
function ends(node, shownElsewhere, isChoice = false) {
  const open = (node.parts ?? []).filter(({ holds }) => !holds);
  if (node.holds) return [];
  if (open.length) return open.flatMap((part) => ends(part, shownElsewhere, isChoice || node.what === "one of"));
  return shownElsewhere.has(`${node.address} ${node.wanted}`) ? [] : [`${isChoice ? "one way: " : ""}${said(node)}`];
}

/** The signals whose conditions are in a tree: a server tells those of a signal only once. */
function told(node, signals = new Set()) {
  if (node.address && node.parts?.length) signals.add(`${node.address} ${node.wanted}`);
  for (const part of node.parts ?? []) told(part, signals);
  return signals;
}

/** The ends of a tree as a list, before the tree. */
export function summary(node) {
  // What ends a signal that is 1 is any of very many things.
  if (node.wanted === "0") return [];
  const open = [...new Set(ends(node, told(node)))];
  if (!open.length) return [];
  const more = open.length - LEAST;
  return [el("p", {}, "Open at the end of the chain:"),
    el("ul", { class: "ends" }, ...open.slice(0, LEAST).map((text) => el("li", {}, text)),
      more > 0 ? el("li", {}, `${more} more, in the tree`) : null)];
}

/** The conditions of a signal from the server; null if it has none. */
export async function conditions(signal, value = null) {
  const query = new URLSearchParams({ signal });
  if (value !== null) query.set("value", value);
  const answer = await fetch(`/api/why?${query}`).catch(() => null);
  if (!answer) return null;
  const told = await answer.json();
  if (answer.ok) return told;
  return { error: `${told.error}: ${told.cure}` };
}

async function refresh() {
  if (!asked || document.hidden || document.body.dataset.view !== "Axes") return;
  const found = await conditions(asked);
  if (!found) return;
  if (found.error) {
    message(found.error, true);
    asked = null;
    return;
  }
  const text = JSON.stringify([found, asked]);
  if (text === shown) return;
  shown = text;
  tree.replaceChildren(...summary(found), el("ul", { class: "tree" }, entry(found)));
}

/** Shows the conditions of a signal, and follows them. */
export function ask(signal) {
  asked = signal;
  input.value = signal;
  location.hash = "#/axes";
  refresh();
}

export function begin() {
  const place = body("why");
  input = el("input", { type: "text", list: "all-signals", autocomplete: "off", placeholder: "X.position_controller_active" });
  const form = el("form", { class: "row", submit: (event) => { event.preventDefault(); ask(input.value.trim()); } },
    field("Signal", input), button("Why not?", () => ask(input.value.trim())));
  const bits = machine.catalogue.signals.filter((signal) => signal.bits === 1 && signal.is_modelled && signal.writer === "nck");
  place.append(form,
    el("datalist", { id: "all-signals" }, ...bits.map((signal) => el("option", { value: signal.symbol }))),
    tree = el("div", {}, el("p", { class: "hint" }, "Shows what a bit of the control waits for before it changes.")));
  const all = el("input", { type: "checkbox", change: () => { showsAll = all.checked; shown = ""; refresh(); } });
  form.append(el("label", { class: "check" }, all, " also what holds"));
  setInterval(refresh, 700);
  addEventListener("hashchange", refresh);
  on("snapshot", () => { shown = ""; });
}
