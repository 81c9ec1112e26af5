// Live: the bridge's page of a running twin, or of a log of one.

import { ask, files, state } from "/app/api.js";
import { doing } from "/app/main.js";
import { button, card, choose, command, el, field, quoted } from "/app/dom.js";
import { kept } from "/app/shared.js";

const NAME = "Live · twin studio";

export async function live() {
  const said = kept("live", () => ({ connect: "tcp/127.0.0.1:7447", log: "", on: "" })), place = el("div", { id: "bridge" }), typed = el("div");
  said.on = state.project.live || "";
  const word = () => typed.replaceChildren(command(said.log ? `twin view ${quoted(said.log)}` : `twin view --connect ${quoted(said.connect)}`));
  const show = () => place.replaceChildren(said.on ? card(`Listening to ${said.on}`, el("iframe", { src: "/live", title: `The twin's bridge: ${said.on}`, onload: titled }), el(".tools", null, el("a.button", { href: "/live", target: "_blank", rel: "noopener" }, "In a window of its own"), button("Leave", doing(async () => { await ask("/api/live", { leave: true }); state.project.live = ""; said.on = ""; document.title = NAME; show(); }), { id: "leave" }))) : el("p.note", null, "No twin is looked at. Attaching listens only: nothing is sent to it."));
  const connect = el("input", { type: "text", id: "connect", value: said.connect, oninput: (e) => { said.connect = e.target.value; word(); } });
  const logs = choose("live-log", [["", "the bus"], ...files("voyage").map((f) => [f.name, `log ${f.name}`])], said.log, (v) => { said.log = v; word(); });
  const attach = doing(async () => { const { name } = await ask("/api/live", said.log ? { log: said.log } : { connect: said.connect }); state.project.live = name; said.on = name; show(); });
  show();
  word();
  return [el("h1", null, "Live"), card("Attach to a running twin", el("form", null, field("where it listens", connect), field("or play", logs), el("button.main", { type: "submit", id: "attach", onclick: attach }, "Attach")), typed), place];
}

/** The tab is named as the bridge's page is, so that what is old is seen from another tab, too. */
function titled(event) {
  const frame = event.target, inside = frame.contentDocument, name = () => { if (frame.isConnected) document.title = `${inside.title} · ${NAME}`; };
  new MutationObserver(name).observe(inside.head, { childList: true, subtree: true, characterData: true });
  name();
}
