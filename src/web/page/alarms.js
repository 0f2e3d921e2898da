// The alarms that are pending: number, place, text, cause, and what cancels them.

import { body, el, say, seconds } from "./dom.js";
import { on } from "./machine.js";

export function begin() {
  const place = body("alarms");
  const list = el("ul", { class: "alarms", role: "list" });
  const none = el("p", {}, "none");
  // Told once for each alarm, not with every change of the list.
  const spoken = el("p", { class: "unseen", role: "alert" });
  place.append(none, list, spoken);
  let shown = "";
  let known = new Set();
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
    const fresh = [...names].filter((name) => !known.has(name));
    if (fresh.length) say(spoken, `Alarm ${fresh.join("; ")}`);
    known = names;
  });
}
