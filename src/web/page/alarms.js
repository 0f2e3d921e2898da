// The alarms that are pending: number, place, text, cause, and what cancels them.

import { body, el, seconds } from "./dom.js";
import { on } from "./machine.js";

export function begin() {
  const place = body("alarms");
  const list = el("ul", { class: "alarms", role: "list" });
  const none = el("p", {}, "none");
  // Told once for each alarm, not with every change of the list.
  const spoken = el("div", { class: "unseen", role: "alert", "aria-atomic": "false", "aria-relevant": "additions" });
  place.append(none, list, spoken);
  let shown = "";
  /** What is spoken of each pending alarm. */
  const known = new Map();
  on("step", ({ now }) => {
    const text = JSON.stringify(now.alarms);
    if (text === shown) return;
    shown = text;
    none.hidden = now.alarms.length > 0;
    list.replaceChildren(...now.alarms.map((alarm) =>
      el("li", {},
        el("p", {}, el("strong", {}, alarm.name), ` ${alarm.place} `, alarm.text),
        el("p", { class: "hint" },
          alarm.because ? `Cause: ${alarm.because}. ` : "",
          alarm.time === null ? "" : `Since ${seconds(alarm.time)}. `,
          alarm.cancelled_by ? `Cancelled by: ${alarm.cancelled_by}.` : ""))));
    const names = new Set(now.alarms.map((alarm) => `${alarm.name} ${alarm.text}`));
    for (const [name, line] of known) {
      if (names.has(name)) continue;
      line.remove();
      known.delete(name);
    }
    for (const name of names) {
      if (known.has(name)) continue;
      const line = el("p", {}, `Alarm ${name}`);
      known.set(name, line);
      spoken.append(line);
    }
  });
}
