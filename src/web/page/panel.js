// Keys that really press: those of the machine control panel if its PLC program runs, else signals of the interface; faults and power.

import { body, button, el, field, say, seconds, set } from "./dom.js";
import { bitOf, command, index, machine, memoryBit, message, on, passed, value } from "./machine.js";

/** The least time of the machine for which a key is pressed: a PLC program must see it. */
const LEAST = 0.02;

let isLatching = false;

const lamps = [];

/** The keys that are pressed: what lets them go, by key. */
const pressedKeys = new Map();

/** Lets keys go that nobody can release any more: those of a page that is left, or of a window in the background. */
function letGo(isLeaving) {
  const signals = [];
  for (const release of [...pressedKeys.values()]) signals.push(...release(isLeaving));
  if (signals.length) command({ set: Object.fromEntries(signals.map((signal) => [signal, 0])) }, true);
}

function lampOf(element, label, isOn) {
  const lamp = el("span", { class: "led", "aria-hidden": "true" });
  lamps.push(() => {
    const is = isOn();
    set(lamp, "data-on", String(is));
    set(element, "aria-label", is ? `${label}, lit` : label);
  });
  return lamp;
}

/** A switch: each press changes its signal, which another client may change as well. */
function toggle(label, signal, isOn = null, kind = null) {
  /** The value that was asked for, until the machine has it. */
  let asked = null;
  const is = () => bitOf(signal) === 1;
  const element = button("", async () => {
    const wanted = !(asked?.wanted ?? is());
    asked = { wanted, step: Infinity };
    show();
    const taken = await command({ set: { [signal]: wanted ? 1 : 0 } });
    asked = taken ? { wanted, step: taken.step } : null;
    show();
  }, { class: "key", "aria-pressed": "false", title: signal, "data-kind": kind });
  const show = () => {
    if (asked && machine.now?.step > asked.step) asked = null;
    set(element, "aria-pressed", String(asked?.wanted ?? is()));
  };
  element.append(...(isOn ? [lampOf(element, label, isOn)] : []), label);
  lamps.push(show);
  return element;
}

/**
 * A key: 1 while it is pressed. `isOn` tells whether its lamp is on. `signals` can depend on the machine. While `stays` is true, it
 * stays pressed after its release.
 */
function key(label, signals, isOn = null, stays = () => false) {
  let pressed = null;
  let isWaiting = false;
  let written = [];
  const all = typeof signals === "function" ? signals : () => signals;
  const element = button("", () => {}, { class: "key", "aria-pressed": "false", title: all().join(", ") });
  element.append(...(isOn ? [lampOf(element, label, isOn)] : []), label);
  const show = () => set(element, "aria-pressed", String(pressed !== null));
  const write = (bit) => Object.fromEntries(written.map((signal) => [signal, bit]));
  const over = () => {
    pressed = null;
    isWaiting = false;
    pressedKeys.delete(element);
    show();
  };
  const press = () => {
    if (pressed !== null) return;
    written = all();
    pressed = command({ set: write(1) }, true);
    pressedKeys.set(element, (isLeaving) => {
      if (!isLeaving && (isLatching || isWaiting)) return [];
      over();
      return written;
    });
    show();
  };
  const release = async () => {
    const mine = pressed;
    if (mine === null) return;
    const taken = await mine;
    if (taken) await passed(taken.step, LEAST);
    // It may have been let go meanwhile.
    if (pressed !== mine) return;
    if (stays()) {
      isWaiting = true;
      return;
    }
    if (taken) await command({ set: write(0) }, true);
    if (pressed === mine) over();
  };
  const begin = () => (isLatching && pressed !== null ? release() : press());
  const end = () => isLatching || release();
  lamps.push(() => {
    if (!isWaiting || stays()) return;
    isWaiting = false;
    release();
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
function has(label, signal, lamp = null, isSwitch = false, kind = null) {
  if (index(signal) === undefined) return null;
  const isOn = lamp ? () => value(lamp) === 1 : null;
  return isSwitch ? toggle(label, signal, isOn, kind) : key(label, [signal], isOn);
}

const isStopped = () => value("nck.emergency_stop_active") === 1;

/** RESET of a channel and its mode group. An emergency stop ends only with RESET of all mode groups. */
function reset(channel) {
  const groups = machine.catalogue.signals.map(({ symbol }) => symbol).filter((symbol) => /^mode_group_\d+\.mode_group_reset$/.test(symbol));
  const signals = () => [...(isStopped() ? groups : groups.slice(0, 1)), `${channel}.channel_reset`];
  if (index(`${channel}.channel_reset`) === undefined) return null;
  return key("RESET", signals, () => value(`${channel}.channel_status_reset`) === 1);
}

/** The acknowledgement stays until RESET has ended the emergency stop: both must be 1 in the same cycle. */
function acknowledge() {
  const signal = "nck.acknowledge_emergency_stop";
  if (index(signal) === undefined) return null;
  const isOpen = () => value("nck.emergency_stop") === 1;
  const element = key("ACKNOWLEDGE", [signal], null, () => isStopped() && !isOpen());
  const hint = el("p", { class: "hint", role: "status" });
  lamps.push(() => say(hint, !isStopped() ? ""
    : isOpen() ? "To leave it: EMERGENCY STOP off, ACKNOWLEDGE, RESET."
    : bitOf(signal) === 1 ? "Acknowledged: press RESET." : "To leave it: ACKNOWLEDGE, then RESET."));
  return [element, hint];
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
  lamps.push(() => {
    if (document.activeElement === override) return;
    let position = 0;
    for (let gray = [4, 3, 2, 1, 0].reduce((code, bit) => code * 2 + memoryBit("I", 3, bit), 0); gray; gray >>= 1) position ^= gray;
    if (position < override.options.length) override.value = String(position);
  });
  const shown = rows.I.map((cells, byte) => cells.map((label, at) => {
    const bit = 7 - at;
    const lit = rows.Q[byte]?.[at] ? () => memoryBit("Q", byte, bit) === 1 : null;
    if (!label || label.startsWith("OVR")) return null;
    // The lamp beside CHAIN is that of the emergency stop, and has its own place.
    return label === "CHAIN" || label.startsWith("KEY") ? toggle(label, `I${byte}.${bit}`) : key(label, [`I${byte}.${bit}`], lit);
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
    return el("span", { class: "lamp-only", "data-kind": label === "stop" || label === "alarm" ? "alarm" : null }, lamp, label, state);
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

/** Why signals do not keep a value: who wrote them last. */
function withoutEffect(names, bit) {
  const [time, by] = machine.writers.get(index(names[0])) ?? [];
  const more = names.length > 1 ? ` and ${names.length - 1} more` : "";
  const { plc } = machine.catalogue;
  const who = by === "plc" ? `the PLC program${plc ? ` ${plc}` : ""}` : by;
  return `without effect: ${names[0]}${more} ${names.length > 1 ? "are" : "is"} ${1 - bit}`
    + `${who ? `, last written by ${who} at ${seconds(time)}` : ""}. Force it in Signals, or stop the PLC.`;
}

function enables() {
  const names = machine.catalogue.axes.flatMap(({ name }) =>
    ["position_measuring_system_1", "controller_enable", "pulse_enable", "drive_enable", "feed_enable"].map((signal) => `${name}.${signal}`))
    .filter((name) => index(name) !== undefined);
  const all = (bit) => async () => {
    const taken = await command({ set: Object.fromEntries(names.map((name) => [name, bit])) });
    if (!taken) return;
    await passed(taken.step, LEAST);
    const other = names.filter((name) => value(name) !== bit);
    if (other.length) message(withoutEffect(other, bit), true);
  };
  return names.length ? [button("Enable all axes", all(1)), button("Disable", all(0))] : [];
}

function override() {
  const channel = machine.catalogue.channels[0];
  const signal = `${channel}.feed_override`;
  if (index(signal) === undefined || index(`${channel}.feed_override_active`) === undefined) return null;
  const choice = el("select", {}, ...[0, 10, 20, 50, 100, 120].map((share) => el("option", { value: share }, `${share} %`)));
  const other = el("option", { value: "", hidden: true, disabled: true }, "another");
  choice.append(other);
  // The override of the channel acts on programs, that of each axis in JOG.
  const axes = machine.catalogue.axes.map(({ name }) => name).filter((name) => index(`${name}.feed_override`) !== undefined);
  choice.addEventListener("change", () => command({ set: Object.fromEntries([
    [signal, `${choice.value}%`], [`${channel}.feed_override_active`, 1],
    ...axes.flatMap((name) => [[`${name}.feed_override`, `${choice.value}%`], [`${name}.override_active`, 1]]),
  ]) }).then(() => choice.blur()));
  const shares = new Map(machine.catalogue.feed_overrides);
  lamps.push(() => {
    if (document.activeElement === choice) return;
    // Without override active, the override is 100 %.
    const share = value(`${channel}.feed_override_active`) === 1 ? shares.get(value(signal)) : 100;
    const shown = [...choice.options].some((option) => option.value === String(share)) ? String(share) : "";
    say(other, share === undefined ? "another" : `${share} %`);
    if (choice.value !== shown) choice.value = shown;
  });
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
      reset(channel), has("START", `${channel}.start`, `${channel}.program_active`),
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
    group("Enables", ...enables()),
    group("Emergency stop", has("EMERGENCY STOP", "nck.emergency_stop", "nck.emergency_stop_active", true, "alarm"),
      acknowledge()),
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
  addEventListener("pagehide", () => letGo(true));
  addEventListener("blur", () => letGo(false));
  document.addEventListener("visibilitychange", () => document.hidden && letGo(true));
  on("snapshot", ({ recent }) => { faults.clear(); note(recent); });
  on("step", ({ edges }) => {
    note(edges);
    for (const lamp of lamps) lamp();
  });
}
