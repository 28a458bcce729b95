"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const byId = (id) => document.getElementById(id);
  const make = (tag, text, parent) => {
    const element = document.createElement(tag);
    if (text !== undefined) element.textContent = text;
    if (parent) parent.append(element);
    return element;
  };
  const draw = (tag, attributes, parent) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    parent.append(element);
    return element;
  };

  const kMostLines = 5;  // of a card, before it is opened

  // Figures as people read them.
  const number = (places, factor = 1, unit = "") => (value) => value === null ? "–"
    : (value * factor).toLocaleString("en", { minimumFractionDigits: places, maximumFractionDigits: places }) + unit;
  const duration = (s) => s >= 5400 ? `${(s / 3600).toFixed(1)} h` : s >= 90 ? `${(s / 60).toFixed(1)} min` : `${s.toFixed(0)} s`;
  const states = { failed: "failed", again: "another walk", unfinished: "unfinished", good: "good" };
  const order = Object.keys(states);
  const sessions = data.sessions.map((session) => ({ ...session,
    rank: order.indexOf(session.state),
    total: Object.values(session.seconds).reduce((a, b) => a + b, 0) }));
  const columns = [
    { key: "name", name: "Session" },
    { key: "rank", name: "State" },
    { key: "frames", name: "Frames", text: number(0) },
    { key: "posed", name: "Posed", text: number(1, 100, " %") },
    { key: "seen", name: "Seen", text: number(1, 100, " %") },
    { key: "psnr", name: "PSNR, dB", text: number(2) },
    { key: "ssim", name: "SSIM", text: number(4) },
    { key: "patches", name: "Patches", text: number(0) },
    { key: "parts", name: "Parts", text: number(0) },
    { key: "model_bytes", name: "Model, MB", text: number(2, 1e-6) },
    { key: "peak_rss_bytes", name: "Memory, MB", text: number(0, 1e-6) },
    { key: "total", name: "Time", text: duration },
  ].filter((column) => column.key !== "parts" || sessions.some((session) => session.parts > 1));
  const view = { sort: "rank", descending: false, hidden: new Set() };
  const shown = () => sessions.filter((session) => !view.hidden.has(session.state));

  // Where the object was seen from: sectors in the order of the report (8 sides, 8 oblique, the top).
  const point = (radius, turns) => [Math.cos(2 * Math.PI * turns), -Math.sin(2 * Math.PI * turns)].map((v) => (radius * v).toFixed(2));
  const ring = (inner, outer, i) => {
    const [a, b, c, d] = [point(inner, i / 8), point(outer, i / 8), point(outer, (i + 1) / 8), point(inner, (i + 1) / 8)];
    return `M${a}L${b}A${outer} ${outer} 0 0 0 ${c}L${d}A${inner} ${inner} 0 0 1 ${a}Z`;
  };
  const plot = (session, parent) => {
    if (session.sectors.length !== 17) return;
    const svg = draw("svg", { viewBox: "-52 -52 104 104", role: "img", "aria-label": "Coverage by direction" }, parent);
    const all = session.sectors.reduce((sum, sector) => sum + sector.patches, 0);
    session.sectors.forEach((sector, i) => {
      const counts = sector.patches >= 0.01 * all;
      const share = sector.patches ? sector.observed / sector.patches : 0;
      const part = i < 16 ? draw("path", { d: ring(i < 8 ? 34 : 17, i < 8 ? 50 : 34, i % 8) }, svg)
                          : draw("circle", { r: 17 }, svg);
      const colour = share >= data.wanted.seen ? "--good" : "--failed";
      part.style.fill = counts ? `color-mix(in srgb, var(${colour}) ${Math.round(35 + 65 * Math.abs(share - (share >= data.wanted.seen ? 0 : 1)))}%, var(--card))`
                               : "var(--none)";
      const psnr = sector.held_out_psnr;
      draw("title", {}, part).textContent = `${sector.where}: ${(100 * share).toFixed(0)} % of ${sector.patches} patches seen, ${
        sector.frames} frames from there${psnr === null ? "" : `, ${psnr.toFixed(1)} dB held out`}`;
      if (psnr !== null && psnr < data.wanted.psnr) {
        const [cx, cy] = i < 16 ? point(i < 8 ? 42 : 25.5, (i % 8 + .5) / 8) : [0, 0];
        draw("circle", { cx, cy, r: 3.4, class: "mark" }, svg);
      }
    });
  };

  const badge = (session, parent) => {
    const state = make("span", states[session.state], parent);
    state.className = "state";
    state.style.setProperty("--state", `var(--${session.state})`);
  };
  const link_names = { "export/model.html": "viewer", "evaluate/sheet.png": "held-out views",
    "register/outline.png": "outline", "survey/board.png": "board", "failed.log": "log" };
  const links = (session, parent) => {
    const line = make("p", undefined, parent);
    line.className = "links";
    for (const [file, path] of Object.entries(session.files)) {
      if (!link_names[file]) continue;
      make("a", link_names[file], line).href = path.split("/").map(encodeURIComponent).join("/");
    }
  };

  const draw_cards = () => {
    const cards = byId("again");
    cards.replaceChildren();
    for (const session of shown().filter((s) => s.state === "failed" || s.again.length > 0)) {
      const card = make("article", undefined, cards);
      card.className = "card";
      plot(session, card);
      const text = make("div", undefined, card);
      const title = make("h2", session.name + " ", text);
      badge(session, title);
      if (session.message) make("p", `${session.failed_step ? session.failed_step + ": " : ""}${session.message}`, text);
      // The disc shows every direction; what is more than a few lines is read by whoever opens it.
      const few = session.again.length > kMostLines ? kMostLines - 1 : session.again.length;
      const list = make("ul", undefined, text);
      for (const line of session.again.slice(0, few)) make("li", line, list);
      if (few < session.again.length) {
        const more = make("details", undefined, text);
        make("summary", `${session.again.length - few} more`, more);
        const rest = make("ul", undefined, more);
        for (const line of session.again.slice(few)) make("li", line, rest);
      }
      links(session, text);
    }
  };

  const draw_table = () => {
    const table = byId("table");
    table.replaceChildren();
    const head = table.createTHead().insertRow();
    make("th", "", head);
    for (const column of columns) {
      const cell = make("th", undefined, head);
      cell.scope = "col";
      if (column.key === view.sort) cell.ariaSort = view.descending ? "descending" : "ascending";
      make("button", column.name, cell).addEventListener("click", () => {
        view.descending = view.sort === column.key && !view.descending;
        view.sort = column.key;
        draw_table();
      });
    }
    const sign = view.descending ? -1 : 1;
    const body = table.createTBody();
    for (const session of shown().sort((a, b) => sign * (typeof a[view.sort] === "string"
      ? a[view.sort].localeCompare(b[view.sort]) : (a[view.sort] ?? -1) - (b[view.sort] ?? -1)))) {
      const line = body.insertRow();
      plot(session, line.insertCell());
      for (const column of columns) {
        const cell = line.insertCell();
        if (column.key === "name") make("b", session.name, cell);
        else if (column.key === "rank") badge(session, cell);
        else cell.textContent = column.text(session[column.key]);
      }
    }
  };

  const draw_states = () => {
    const group = byId("states");
    group.replaceChildren();
    for (const state of order.filter((name) => data.counts[name] > 0)) {
      const button = make("button", undefined, group);
      button.type = "button";
      button.ariaPressed = String(!view.hidden.has(state));
      make("i", undefined, button).style.setProperty("--dot", `var(--${state})`);
      button.append(`${states[state]} ${data.counts[state]}`);
      button.addEventListener("click", () => {
        if (!view.hidden.delete(state)) view.hidden.add(state);
        draw_all();
      });
    }
  };

  const draw_all = () => { draw_states(); draw_cards(); draw_table(); };
  const to_see_to = data.counts.again + data.counts.failed;
  byId("headline").textContent = to_see_to === 0 ? `All ${sessions.length} sessions are as wanted`
    : `${to_see_to} of ${sessions.length} sessions need a look`;
  byId("wanted-psnr").textContent = data.wanted.psnr;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const set_theme = (name) => { root.dataset.theme = name; root.style.colorScheme = name; };
  byId("theme").addEventListener("click", () => set_theme(root.dataset.theme === "dark" ? "light" : "dark"));
  dark.addEventListener("change", () => set_theme(dark.matches ? "dark" : "light"));
  set_theme(dark.matches ? "dark" : "light");
  draw_all();
})();
