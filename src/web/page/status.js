// The status bar: time, mode, PLC, connection; pause, single steps, speed, back in time.

import { button, el, field, say, seconds, set } from "./dom.js";
import { command, index, machine, on, value } from "./machine.js";

const LINKS = {
  connecting: "connecting",
  live: "live",
  lost: "connection lost: what is shown is old",
};
const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 10, 100];
const MODES = [
  ["mode_group_1.active_mode_automatic", "AUTO"],
  ["mode_group_1.active_mode_mdi", "MDA"],
  ["mode_group_1.active_mode_jog", "JOG"],
  ["mode_group_1.active_machine_function_ref", "REF"],
];

const facts = new Map();

function fact(name) {
  const shown = el("dd");
  facts.set(name, shown);
  return el("div", {}, el("dt", {}, name), shown);
}

/** The time to which the slider points; it follows the machine while nobody moves it. */
let isHeld = false;
/** The seconds back from now, if they were typed. */
let ago = null;

function back() {
  const slider = el("input", { type: "range", min: 0, max: 0, step: "any", id: "moment" });
  const shown = el("output", { for: "moment" });
  const before = el("input", { type: "number", min: 0, step: "any", class: "short" });
  const hold = () => {
    isHeld = true;
    ago = null;
    before.value = (machine.now.time - Number(slider.value)).toFixed(2);
    say(shown, `${Number(slider.value).toFixed(2)} s`);
  };
  before.addEventListener("input", () => {
    ago = before.value === "" ? null : Math.max(Number(before.value) || 0, 0);
    isHeld = false;
  });
  const go = async () => {
    const { now, catalogue } = machine;
    const cycles = Math.round((ago ?? now.time - Number(slider.value)) / catalogue.cycle);
    isHeld = false;
    ago = null;
    before.value = "";
    const first = Array.isArray(now.reach.Ok) ? now.reach.Ok[0] : 0;
    await command({ go_back: Math.max(now.cycle - cycles, first) });
  };
  slider.addEventListener("input", hold);
  const buttonBack = button("Go back", go);
  const form = el("details", { class: "back" }, el("summary", {}, "Back in time"),
    el("div", { class: "row" }, field("Moment", slider), shown, field("Seconds back", before), buttonBack),
    el("p", { class: "hint" }, ""));
  on("step", ({ now }) => {
    const reach = now.reach.Ok;
    slider.disabled = before.disabled = buttonBack.disabled = !reach;
    say(form.querySelector(".hint"), reach
      ? `From ${seconds(reach[1])} on. The machine pauses there; what happened later is forgotten when it goes on.`
      : `${now.reach.Err}.`);
    if (!reach) return;
    set(slider, "min", String(reach[1]));
    set(slider, "max", String(now.time));
    if (!isHeld) {
      const moment = Math.max(now.time - (ago ?? 0), reach[1]);
      slider.value = moment;
      say(shown, `${moment.toFixed(2)} s`);
    }
  });
  return form;
}

export function begin() {
  const bar = document.querySelector("#status");
  for (const name of ["Time", "Cycle", "Mode", "PLC", "Speed"]) bar.append(fact(name));
  // A control without modes has none to show.
  facts.get("Mode").parentElement.hidden = MODES.every(([symbol]) => index(symbol) === undefined);
  const link = document.querySelector("#link");
  on("link", (state) => {
    say(link, LINKS[state]);
    document.body.classList.toggle("stale", state !== "live");
  });

  const drive = document.querySelector("#drive");
  const pause = button("Pause", () => command({ pause: !machine.now.paused }));
  const count = el("input", { type: "number", min: 1, max: 100000, value: 1, class: "short" });
  const step = button("Step", () => command({ step: Number(count.value) || 1 }));
  const speed = el("select", { change: () => command({ speed: Number(speed.value) }) },
    ...SPEEDS.map((factor) => el("option", { value: factor }, `${factor}`)));
  drive.append(pause, step, field("Cycles", count), field("Speed", speed), back());

  on("step", ({ now }) => {
    say(facts.get("Time"), seconds(now.time));
    say(facts.get("Cycle"), `${now.cycle}`);
    const modes = MODES.filter(([symbol]) => value(symbol) === 1).map(([, name]) => name);
    say(facts.get("Mode"), modes.join(" ") || "none");
    say(facts.get("PLC"), now.plc + (machine.catalogue.plc ? `, ${machine.catalogue.plc}` : ", no program"));
    say(facts.get("Speed"), now.held ? "waits for the PLC process" : now.paused ? "paused" : `${now.speed}`);
    say(pause, now.paused ? "Go on" : "Pause");
    if (document.activeElement !== speed) {
      if (!SPEEDS.includes(now.speed) && ![...speed.options].some((option) => Number(option.value) === now.speed)) {
        speed.append(el("option", { value: now.speed }, `${now.speed}`));
      }
      speed.value = String(now.speed);
    }
  });
}
