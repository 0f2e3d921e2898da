// The steps of the scenario that runs, what happened, and the session as a scenario.

import { body, el, say, seconds } from "./dom.js";
import { machine, on } from "./machine.js";

const STATES = { running: "runs", passed: "has passed", failed: "has failed" };
const LINES = 30;

export function begin() {
  const place = body("scenario");
  const { steps } = machine.catalogue;
  const state = el("p", { role: "status" });
  const failure = el("pre", { class: "failure", hidden: true });
  const items = steps.map(({ line, note, text }) => el("li", {},
    el("span", { class: "hint" }, `line ${line} `), note ? el("strong", {}, note) : "", el("pre", {}, text)));
  const log = el("ol", { class: "log", "aria-label": "What happened" });
  place.append(state, failure, el("ol", { class: "steps" }, ...items),
    el("h3", {}, "What happened"), log,
    el("h3", {}, "Save"),
    el("p", {}, el("a", { href: "/api/recording", download: "session.toml" }, "Save everything since power on as a scenario"),
      ". Put the file into the folder in which the server was started; “opennck run session.toml” repeats it."));
  let current = null;
  on("step", ({ now }) => {
    const of = now.scenario;
    say(state, of ? `The scenario ${STATES[of.state]}: step ${Math.min(of.index + 1, steps.length)} of ${steps.length}.`
      : steps.length ? "The scenario has ended: the machine went back in time." : "No scenario runs. Start the server with --scenario.");
    failure.hidden = !of?.failure;
    say(failure, of?.failure ?? "");
    items.forEach((item, at) => {
      item.classList.toggle("done", Boolean(of) && at < of.index);
    });
    const next = of?.state === "running" ? items[of.index] : null;
    if (next !== current) {
      current?.removeAttribute("aria-current");
      next?.setAttribute("aria-current", "step");
      current = next;
    }
    const told = machine.edges.filter(({ kind }) => kind).slice(-LINES).reverse();
    const lines = told.map(({ t, a, v, kind, why }) =>
      `${seconds(t)}  ${kind === "alarm" ? (v ? "alarm " : "cancelled: ") : ""}${a}${why ? `  ${why}` : ""}`);
    if (log.dataset.shown === lines.join("\n")) return;
    log.dataset.shown = lines.join("\n");
    log.replaceChildren(...lines.map((line) => el("li", {}, line)));
  });
}
