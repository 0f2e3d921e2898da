// The machine as the server tells it: the catalogue once, then a snapshot and the changes. Other modules listen.

export const machine = {
  catalogue: null,
  now: null,
  values: [],
  writers: new Map(),
  /** What happened, oldest first: {t, i | a, v, by, why, kind}. */
  edges: [],
  /** Samples of axis values, oldest first: [time, axes]. */
  samples: [],
  link: "connecting",
  /** The number of this page's stream. */
  client: null,
};

const KEPT = 20000;
const SAMPLES = 6000;
/** Without an event for so long, what is shown is old. The server tells the state twice a second. */
const SILENT = 2000;
/** A step so far behind that of an answer is one of another server. */
const RESTARTED = 1000;

const listeners = { snapshot: [], step: [], link: [], message: [], taken: [] };
const symbols = new Map();
const addresses = new Map();
let source = null;
let last = 0;
let text = null;

export function on(kind, listener) {
  listeners[kind].push(listener);
}

function tell(kind, what) {
  for (const listener of listeners[kind]) listener(what);
}

/** The index of a signal by symbol or address; undefined if the machine does not have it. */
export function index(name) {
  return symbols.get(name) ?? addresses.get(name);
}

export function value(name) {
  const found = index(name);
  return found === undefined ? undefined : machine.values[found];
}

/** A bit of inputs, outputs or flags: `I0.3`. */
export function memoryBit(area, byte, bit) {
  const hex = machine.now?.memory["IQM".indexOf(area)] ?? "";
  return (parseInt(hex.slice(byte * 2, byte * 2 + 2) || "0", 16) >> bit) & 1;
}

/** A bit by symbol, address of the interface, or address of inputs, outputs or flags; undefined if it is unknown. */
export function bitOf(name) {
  const found = /^([IQM])(\d+)\.([0-7])$/.exec(name);
  return found ? memoryBit(found[1], Number(found[2]), Number(found[3])) : value(name);
}

export function message(said, isError = false) {
  tell("message", { said, isError });
}

/**
 * Sends a command; returns {cycle, step}, or null after telling why it was refused. The server sets signals that are held to 0 when
 * the stream of this page ends.
 */
export async function command(body, isHeld = false) {
  try {
    const answer = await fetch(isHeld && machine.client !== null ? `/api/command?client=${machine.client}` : "/api/command", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
      // A page that is left still releases its keys.
      keepalive: true,
    });
    const told = await answer.json();
    if (answer.ok) {
      tell("taken", told);
      return told;
    }
    message(`${told.error}: ${told.cure}`, true);
  } catch {
    message("the server does not answer", true);
  }
  return null;
}

/** Resolves when the machine has taken a step and this time, in seconds, has passed on it. */
export function passed(step, time) {
  const from = machine.now?.time ?? 0;
  return new Promise((resolve) => {
    const look = ({ now }) => {
      // After going back in time, its time is another one; after a restart of the server, its steps are.
      const isAnother = now.time < from || now.step + RESTARTED < step;
      if (isAnother || (now.step > step && now.time - from >= time)) {
        listeners.step.splice(listeners.step.indexOf(look), 1);
        resolve();
      }
    };
    listeners.step.push(look);
  });
}

function link(state) {
  if (machine.link !== state) {
    machine.link = state;
    tell("link", state);
  }
}

function take(now) {
  machine.now = now;
  last = performance.now();
  const before = machine.samples.at(-1);
  if (before && now.time < before[0]) machine.samples = machine.samples.filter(([time]) => time <= now.time);
  if (!before || now.time > before[0]) machine.samples.push([now.time, now.axes]);
  if (machine.samples.length > SAMPLES) machine.samples.splice(0, SAMPLES / 4);
  link("live");
}

function open() {
  source = new EventSource("/events");
  source.addEventListener("snapshot", (event) => {
    const told = JSON.parse(event.data);
    machine.values = told.values;
    machine.writers = new Map(told.writers);
    machine.edges = told.recent;
    machine.client = told.client ?? machine.client;
    take(told.now);
    tell("snapshot", told);
    tell("step", told);
  });
  source.addEventListener("step", (event) => {
    const told = JSON.parse(event.data);
    for (const edge of told.edges) {
      if (edge.i === undefined) continue;
      machine.values[edge.i] = edge.v;
      machine.writers.set(edge.i, [edge.t, edge.by, edge.why ?? null]);
    }
    machine.edges.push(...told.edges);
    if (machine.edges.length > KEPT) machine.edges.splice(0, KEPT / 4);
    take(told.now);
    tell("step", told);
  });
  source.addEventListener("open", check);
  source.addEventListener("error", () => {
    link("lost");
    // A browser does not try again after an answer that is no stream.
    if (source.readyState === EventSource.CLOSED) setTimeout(reopen, 2000);
  });
}

function close() {
  source?.close();
  source = null;
}

function reopen() {
  close();
  open();
}

/** Another machine may be there after a restart: then the page begins anew. */
async function check() {
  if (machine.link === "connecting") return;
  const answer = await fetch("/api/catalogue").catch(() => null);
  if (answer?.ok && (await answer.text()) !== text) location.reload();
}

/** The token in the address is exchanged once for a cookie. */
async function exchange() {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (!token) return;
  history.replaceState(null, "", location.pathname);
  const headers = { "Content-Type": "application/json" };
  await fetch("/api/token", { method: "POST", headers, body: JSON.stringify({ token }) }).catch(() => null);
}

export async function start() {
  await exchange();
  text = await (await fetch("/api/catalogue")).text();
  machine.catalogue = JSON.parse(text);
  machine.catalogue.signals.forEach((signal, at) => {
    symbols.set(signal.symbol, at);
    addresses.set(signal.address, at);
  });
}

export function follow() {
  open();
  setInterval(() => {
    if (source && performance.now() - last > SILENT) link(machine.now ? "lost" : "connecting");
  }, 500);
  // A browser has six connections to a server: a page that nobody sees needs none.
  addEventListener("pagehide", close);
  addEventListener("pageshow", (event) => event.persisted && reopen());
  document.addEventListener("visibilitychange", () => (document.hidden ? close() : reopen()));
}
