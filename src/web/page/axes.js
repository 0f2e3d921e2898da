// The axes: positions, following errors, enables and states.

import { body, button, el, say, set } from "./dom.js";
import { index, machine, on, value } from "./machine.js";
import { ask } from "./why.js";

const COLUMNS = ["Position", "Setpoint", "Velocity", "Following error", "Synchronism difference", "Slide"];
const DIGITS = [4, 4, 1, 4, 4, 4];

/** Signals that tell of something wrong while they are 1; others of an axis tell only what it does. */
const KINDS = new Map([["feed_stop", "warning"], ["axis_specific_alarm", "alarm"], ["error", "alarm"]]);
/** What only an axis of a gantry grouping has. */
const OF_GANTRY = ["gantry_leading_axis", "gantry_grouping_is_synchronized", "gantry_synchronization_ready_to_start"];
const DIFFERENCE = COLUMNS.indexOf("Synchronism difference");

/** Enables that an axis needs, then its states; those that the machine has are shown. */
const SIGNALS = [
  ["controller_enable", "controller enable"],
  ["pulse_enable", "pulse enable"],
  ["position_measuring_system_1", "measuring system 1"],
  ["feed_stop", "feed stop"],
  ["drive_enable", "drive enable"],
  ["feed_enable", "feed enable"],
  ["position_controller_active", "position control"],
  ["referenced_synchronized_1", "referenced"],
  ["traverse_command_plus", "moves +"],
  ["traverse_command_minus", "moves -"],
  ["axis_specific_alarm", "alarm"],
  ["gantry_leading_axis", "leading axis"],
  ["gantry_axis", "gantry axis"],
  ["gantry_grouping_is_synchronized", "synchronized"],
  ["gantry_synchronization_ready_to_start", "ready to start"],
  ["drive_ready", "drive ready"],
  ["homed", "homed"],
  ["in_position", "in position"],
  ["error", "error"],
  ["gantry_coupled", "coupled"],
];

/** Whether the control says that an axis is in no gantry grouping. */
function isAlone(axis) {
  return value(`${axis}.gantry_axis`) === 0;
}

export function begin() {
  const place = body("axes");
  const cells = [];
  const lamps = [];
  const rows = machine.catalogue.axes.map((axis) => {
    const values = COLUMNS.map((column) => el("td", { "data-label": column }));
    cells.push(values);
    const signals = SIGNALS.map(([name, label]) => {
      const at = index(`${axis.name}.${name}`);
      if (at === undefined || machine.catalogue.signals[at].bits !== 1) return null;
      const state = el("span", { class: "bit" });
      const lamp = button("", () => ask(`${axis.name}.${name}`), { class: "lamp", "data-kind": KINDS.get(name), title: machine.catalogue.signals[at].doc });
      lamp.append(label, " ", state);
      lamps.push([at, lamp, state, OF_GANTRY.includes(name) ? axis.name : null]);
      return lamp;
    });
    return el("tbody", {},
      el("tr", {}, el("th", { scope: "row", rowspan: 2 }, axis.name), ...values),
      el("tr", {}, el("td", { colspan: COLUMNS.length, class: "lamps" }, ...signals)));
  });
  place.append(el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Axes, table" },
    el("table", { class: "axes" },
      el("caption", {}, "mm, degrees, mm/min. A lamp shows 1 or 0; press one to see what its value depends on."),
      el("thead", {}, el("tr", {}, el("td"), ...COLUMNS.map((column) => el("th", { scope: "col" }, column)))),
      ...rows)));
  on("step", ({ now }) => {
    now.axes.forEach((values, axis) => values.forEach((value, at) => {
      // Half a digit below zero is no negative number.
      const shown = at === DIFFERENCE && isAlone(machine.catalogue.axes[axis].name) ? "-" : value.toFixed(DIGITS[at]);
      say(cells[axis][at], Number(shown) === 0 ? (0).toFixed(DIGITS[at]) : shown);
    }));
    for (const [at, lamp, state, gantry] of lamps) {
      const is = machine.values[at] === 1;
      say(state, is ? lamp.dataset.kind ? "1 !" : "1" : "0");
      if (gantry !== null) lamp.hidden = isAlone(gantry);
      set(lamp, "data-on", String(is));
    }
  });
}
