// Keys that really press: those of the machine control panel if its PLC program runs, else signals of the interface; faults and power.

import { body, button, el, field, set } from "./dom.js";
import { command, index, machine, memoryBit, on, passed, value } from "./machine.js";

/** The least time of the machine for which a key is pressed: a PLC program must see it. */
const LEAST = 0.02;

let isLatching = false;

const lamps = [];

/** A key: 1 while it is pressed. `isOn` tells whether its lamp is on. */
function key(label, signal, isOn = null, isSwitch = false) {
  let pressed = null;
  const element = button("", () => {}, { class: "key", "aria-pressed": "false", title: signal });
  const lamp = el("span", { class: "led", "aria-hidden": "true" });
  element.append(...(isOn ? [lamp] : []), label);
  if (isOn) lamps.push(() => {
    const is = isOn();
    set(lamp, "data-on", String(is));
    set(element, "aria-label", is ? `${label}, lit` : label);
  });
  const show = () => set(element, "aria-pressed", String(pressed !== null));
  const press = () => {
    if (pressed !== null) return;
    pressed = command({ set: { [signal]: 1 } });
    show();
  };
  const release = async () => {
    if (pressed === null) return;
    const taken = await pressed;
    if (taken) {
      await passed(taken.step, LEAST);
      await command({ set: { [signal]: 0 } });
    }
    pressed = null;
    show();
  };
  const isSticky = () => isSwitch || isLatching;
  const begin = () => (isSticky() && pressed !== null ? release() : press());
  const end = () => isSticky() || release();
  if (isSwitch) lamps.push(() => {
    // Another client may have switched it.
    if (value(signal) === 1 && pressed === null) pressed = Promise.resolve({ step: 0 });
    show();
  });
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture?.(event.pointerId);
    begin();
  });
  for (const kind of ["pointerup", "pointercancel", "blur"]) element.addEventListener(kind, end);
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    if (!event.repeat) begin();
  });
  element.addEventListener("keyup", (event) => (event.key === " " || event.key === "Enter") && end());
  // A screen reader clicks without a pointer.
  element.addEventListener("click", (event) => {
    if (event.detail === 0 && event.isTrusted) {
      begin();
      end();
    }
  });
  return element;
}

function group(name, ...keys) {
  const shown = keys.flat().filter(Boolean);
  return shown.length ? el("fieldset", { class: "group" }, el("legend", {}, name), ...shown) : null;
}

/** A key of a signal if the machine has it. */
function has(label, signal, lamp = null, isSwitch = false) {
  if (index(signal) === undefined) return null;
  return key(label, signal, lamp ? () => value(lamp) === 1 : null, isSwitch);
}

/** The keys of the panel from its layout: nine letters for each bit. */
function panel(layout) {
  const rows = { I: [], Q: [] };
  for (const line of layout.split("\n").filter((line) => /^[IQ]B\d/.test(line))) {
    const cells = Array.from({ length: 8 }, (_, at) => line.slice(5 + at * 9, 14 + at * 9).trim());
    rows[line[0]][Number(line[2])] = cells.map((label) => (label === "." ? "" : label));
  }
  const override = el("select", {}, ...Array.from({ length: 31 }, (_, at) => el("option", { value: at }, `${at + 1}`)));
  override.addEventListener("change", () => {
    const gray = Number(override.value) ^ (Number(override.value) >> 1);
    const bits = Object.fromEntries([0, 1, 2, 3, 4].map((bit) => [`I3.${bit}`, (gray >> bit) & 1]));
    command({ set: bits });
  });
  const shown = rows.I.map((cells, byte) => cells.map((label, at) => {
    const bit = 7 - at;
    const lit = rows.Q[byte]?.[at] ? () => memoryBit("Q", byte, bit) === 1 : null;
    if (!label || label.startsWith("OVR")) return null;
    return key(label, `I${byte}.${bit}`, lit, label === "CHAIN" || label.startsWith("KEY"));
  }).filter(Boolean).reverse());
  const only = (byte) => (rows.Q[byte] ?? []).map((label, at) => [label, 7 - at]).filter(([label, bit]) =>
    label && label !== rows.I[byte]?.[7 - bit]).reverse().map(([label, bit]) => {
    const lamp = el("span", { class: "led" });
    const state = el("span", { class: "unseen" });
    lamps.push(() => {
      const is = memoryBit("Q", byte, bit) === 1;
      set(lamp, "data-on", String(is));
      state.textContent = is ? " lit" : " dark";
    });
    return el("span", { class: "lamp-only" }, lamp, label, state);
  });
  const names = ["Mode", "Machine function", "Program", "Block", "Axis", "Direction", "Referenced", "Emergency stop"];
  return el("div", { class: "panel" }, ...names.map((name, byte) =>
    group(name, byte === 3 ? field("Override position", override) : null, shown[byte] ?? [], only(byte))));
}

/** Modes exclude each other: a request sets the others to 0. */
function mode(label, on, lamp) {
  const all = ["mode_automatic", "mode_mdi", "mode_jog", "machine_function_ref"];
  if (index("mode_group_1.mode_jog") === undefined) return null;
  const led = el("span", { class: "led", "aria-hidden": "true" });
  const element = button("", () => command({
    set: Object.fromEntries(all.map((name) => [`mode_group_1.${name}`, on.includes(name) ? 1 : 0])),
  }), { class: "key" });
  element.append(led, label);
  lamps.push(() => {
    const is = lamp();
    set(led, "data-on", String(is));
    set(element, "aria-pressed", String(is));
  });
  return element;
}

function enables() {
  const names = machine.catalogue.axes.flatMap(({ name }) =>
    ["position_measuring_system_1", "controller_enable", "pulse_enable", "drive_enable", "feed_enable"].map((signal) => `${name}.${signal}`))
    .filter((name) => index(name) !== undefined);
  const all = (bit) => () => command({ set: Object.fromEntries(names.map((name) => [name, bit])) });
  return names.length ? [button("Enable all axes", all(1)), button("Disable", all(0))] : [];
}

function override() {
  const channel = machine.catalogue.channels[0];
  const signal = `${channel}.feed_override`;
  if (index(signal) === undefined || index(`${channel}.feed_override_active`) === undefined) return null;
  const choice = el("select", {}, ...[0, 10, 20, 50, 100, 120].map((share) =>
    el("option", { value: share, selected: share === 100 }, `${share} %`)));
  choice.addEventListener("change", () => command({ set: { [signal]: `${choice.value}%`, [`${channel}.feed_override_active`]: 1 } }));
  return field("Feed override", choice);
}

function interfaceKeys() {
  const is = (name) => () => value(`mode_group_1.${name}`) === 1;
  const ref = is("active_machine_function_ref");
  const channel = machine.catalogue.channels[0];
  return [
    group("Mode", mode("AUTO", ["mode_automatic"], is("active_mode_automatic")), mode("MDA", ["mode_mdi"], is("active_mode_mdi")),
      mode("JOG", ["mode_jog"], () => is("active_mode_jog")() && !ref()), mode("REF", ["mode_jog", "machine_function_ref"], ref)),
    group("Program", has("START", `${channel}.nc_start`, `${channel}.program_status_running`), has("STOP", `${channel}.nc_stop`),
      has("RESET", `${channel}.channel_reset`, `${channel}.channel_status_reset`), has("START", `${channel}.start`, `${channel}.program_active`),
      has("RESET", `${channel}.reset`), has("FEED HOLD", `${channel}.feed_hold`, null, true),
      has("SINGLE BLOCK", `${channel}.activate_single_block`, null, true), override()),
    group("Axes", ...machine.catalogue.axes.flatMap(({ name }) => [
      has(`${name} -`, `${name}.traversing_key_minus`, `${name}.traverse_command_minus`),
      has(`${name} +`, `${name}.traversing_key_plus`, `${name}.traverse_command_plus`)])),
    group("Gantry", ...machine.catalogue.axes.map(({ name }) => {
      const start = has(`Start synchronization ${name}`, `${name}.start_gantry_synchronization`, `${name}.gantry_grouping_is_synchronized`);
      // Which axis leads is known when the machine has run up.
      if (start) lamps.push(() => { start.hidden = value(`${name}.gantry_leading_axis`) !== 1; });
      return start;
    })),
    group("Enables", enables()),
    group("Emergency stop", has("EMERGENCY STOP", "nck.emergency_stop", "nck.emergency_stop_active", true),
      has("ACKNOWLEDGE", "nck.acknowledge_emergency_stop")),
  ];
}

const LASTING = ["block", "drive_fault", "encoder_fault", "zero_mark_missing", "drive_not_ready"];
const AMOUNTS = { push: "mm", encoder_slip: "mm", friction: "share", drift: "mm/s", hold: "mm" };

/** Faults that act now, as the record tells them: `fault block XF set`. */
const faults = new Set();

function note(edges) {
  for (const { a, kind } of edges ?? []) {
    const [, name, axis, change] = (kind === "event" && /^fault (\w+).* (\S+) (set|cleared)$/.exec(a)) || [];
    if (change === "set") faults.add(`${name} ${axis}`);
    if (change === "cleared") faults.delete(`${name} ${axis}`);
  }
}

function faultKeys() {
  const toggles = machine.catalogue.axes.map(({ name: axis }) => group(`Axis ${axis}`, ...LASTING.map((kind) => {
    const element = button(kind.replaceAll("_", " "), () => {
      const verb = faults.has(`${kind} ${axis}`) ? "clear_fault" : "fault";
      command({ [verb]: { axis, kind } });
    }, { class: "key fault", "aria-label": `Fault ${kind.replaceAll("_", " ")} of ${axis}` });
    lamps.push(() => set(element, "aria-pressed", String(faults.has(`${kind} ${axis}`))));
    return element;
  })));
  const axis = el("select", {}, ...machine.catalogue.axes.map(({ name }) => el("option", {}, name)));
  const kind = el("select", {}, ...Object.entries(AMOUNTS).map(([name, unit]) => el("option", { value: name }, `${name.replace("_", " ")} (${unit})`)));
  const by = el("input", { type: "number", step: "any", value: 0.05, class: "short" });
  const send = (verb) => () => command({ [verb]: { axis: axis.value, kind: kind.value, ...(verb === "fault" ? { by: Number(by.value) } : {}) } });
  return [...toggles, group("With an amount", field("Axis", axis), field("Fault", kind), field("Amount", by),
    button("Cause", send("fault")), button("Clear", send("clear_fault")))];
}

export function begin() {
  const latch = el("input", { type: "checkbox", change: () => { isLatching = latch.checked; } });
  const keys = body("keys");
  keys.append(el("label", { class: "check" }, latch, " keys stay pressed until they are pressed again"));
  if (machine.catalogue.panel) keys.append(panel(machine.catalogue.panel));
  else keys.append(...interfaceKeys().filter(Boolean));
  const channel = machine.catalogue.channels[0];
  body("faults").append(
    group("Power and alarms", button("Power off and on", () => command({ power_on: true })),
      button("Cancel alarms", () => command({ cancel: true })),
      machine.catalogue.panel ? null : has("Channel reset", `${channel}.channel_reset`),
      button("Stop the PLC", () => command({ plc: "stop" })), button("Start the PLC", () => command({ plc: "run" }))),
    ...faultKeys());
  on("snapshot", ({ recent }) => { faults.clear(); note(recent); });
  on("step", ({ edges }) => {
    note(edges);
    for (const lamp of lamps) lamp();
  });
}
