// The page: starts the machine's stream and the views.

import { el, say, set } from "./dom.js";
import { follow, machine, on, start } from "./machine.js";
import * as alarms from "./alarms.js";
import * as axes from "./axes.js";
import * as charts from "./charts.js";
import * as diagram from "./diagram.js";
import * as panel from "./panel.js";
import * as scenario from "./scenario.js";
import * as signals from "./signals.js";
import * as status from "./status.js";
import * as why from "./why.js";

const VIEWS = ["Axes", "Keys", "Flowchart", "Signals", "Diagram", "Scenario"];

function views() {
  const list = document.querySelector("#views");
  const show = (view) => {
    for (const section of document.querySelectorAll("[data-view]")) section.classList.toggle("shown", section.dataset.view === view);
    for (const link of list.querySelectorAll("a")) {
      if (link.textContent === view) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    document.body.dataset.view = view;
    diagram.draw();
  };
  const wanted = () => VIEWS.find((view) => `#/${view.toLowerCase()}` === location.hash) ?? VIEWS[0];
  for (const view of VIEWS) list.append(el("li", {}, el("a", { href: `#/${view.toLowerCase()}` }, view)));
  addEventListener("hashchange", () => show(wanted()));
  show(wanted());
}

/** The heights of what stays above the alarms on a phone. */
function heights() {
  const parts = { "--status": document.querySelector("#status"), "--views": document.querySelector("nav") };
  const measure = () => {
    for (const [name, part] of Object.entries(parts)) document.documentElement.style.setProperty(name, `${part.offsetHeight}px`);
  };
  const watcher = new ResizeObserver(measure);
  for (const part of Object.values(parts)) watcher.observe(part);
}

function messages() {
  const place = document.querySelector("#message");
  let timer = 0;
  on("message", ({ said, isError }) => {
    say(place, said);
    set(place, "class", isError ? "message error" : "message");
    clearTimeout(timer);
    timer = setTimeout(() => say(place, ""), isError ? 20000 : 8000);
  });
  // What was wrong is over when the next command is taken.
  on("taken", () => {
    if (place.classList.contains("error")) say(place, "");
  });
}

const { hash } = location;
await start();
if (!hash.includes("token=")) history.replaceState(null, "", hash || location.pathname);
say(document.querySelector("#title"), machine.catalogue.title.split("/").filter(Boolean).at(-1) ?? "OpenNCK");
document.title = `${machine.catalogue.title} - OpenNCK`;
if (machine.catalogue.read_only) document.body.classList.add("read-only");
messages();
for (const view of [status, alarms, axes, why, charts, signals, diagram, scenario, panel]) view.begin();
views();
heights();
follow();
