// Why a signal does not have another value: the conditions that the control tests, with what it finds and who wrote it.

import { body, button, el, field, say, seconds } from "./dom.js";
import { machine, message, on } from "./machine.js";

let asked = null;
let shown = "";
let tree;
let input;

/** A condition as an entry of a list. */
export function entry(node, isOpen = true) {
  const value = node.found === undefined ? "" : node.holds ? ` = ${node.found}` : ` = ${node.found}, wanted ${node.wanted}`;
  const written = node.written ? `, written by ${node.written[1]} at ${seconds(node.written[0])}` : "";
  const side = node.writer && !node.holds && !node.parts?.length ? `: ${node.writer} signal${written}` : "";
  const line = [
    el("span", { class: node.holds ? "mark holds" : "mark open" }, node.holds ? "holds" : "open"),
    ` ${node.what}${node.address && node.address !== node.what ? ` (${node.address})` : ""}${value}${side}`,
  ];
  const parts = (node.parts ?? []).map((part) => entry(part));
  return parts.length
    ? el("li", {}, ...line, el("ul", { class: "tree" }, ...parts))
    : el("li", {}, ...line);
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
  if (!asked || document.hidden) return;
  const told = await conditions(asked);
  if (!told) return;
  if (told.error) {
    message(told.error, true);
    asked = null;
    return;
  }
  const text = JSON.stringify([told, asked]);
  if (text === shown) return;
  shown = text;
  tree.replaceChildren(el("ul", { class: "tree" }, entry(told)));
}

/** Shows the conditions of a signal, and follows them. */
export function ask(signal) {
  asked = signal;
  input.value = signal;
  refresh();
  const section = document.querySelector("#why");
  if (!section.classList.contains("shown")) location.hash = "#axes";
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
  setInterval(refresh, 700);
  on("snapshot", () => { shown = ""; });
}
