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

  // Figures as people read them.
  const digits = (value, places) => value.toLocaleString("en", {
    minimumFractionDigits: places, maximumFractionDigits: places });
  const milliseconds = (ms) => ms >= 1000 ? `${+(ms / 1000).toPrecision(3)} s` : `${+ms.toPrecision(3)} ms`;
  const bytes = (count) => {
    for (const [unit, size] of [["GB", 1e9], ["MB", 1e6], ["kB", 1e3]]) {
      if (count >= size) return `${+(count / size).toPrecision(3)} ${unit}`;
    }
    return `${count} B`;
  };

  const costs = [
    { canvas: "chart-bytes", key: "model_bytes", front: "front_bytes", text: bytes },
    { canvas: "chart-fit", key: "fit_ms_per_frame", front: "front_fit_time", text: milliseconds },
    { canvas: "chart-render", key: "render_ms_per_view", front: "front_render_time", text: milliseconds },
  ];
  const columns = [
    { key: "label", name: "Candidate", text: (v) => v, least: true },
    { key: "psnr", name: "PSNR, dB", text: (v) => digits(v, 2) },
    { key: "live_psnr", name: "Live, dB", text: (v) => digits(v, 2) },
    { key: "worst_psnr", name: "Worst, dB", text: (v) => digits(v, 2) },
    { key: "box_psnr", name: "Outline, dB", text: (v) => digits(v, 2) },
    { key: "ssim", name: "SSIM", text: (v) => digits(v, 4) },
    { key: "rmse", name: "RMSE", text: (v) => digits(v, 4), least: true },
    { key: "edge_difference", name: "Edges", text: (v) => digits(v, 2), least: true },
    { key: "holes", name: "Holes, %", text: (v) => digits(100 * v, 2), least: true },
    { key: "pop_ratio", name: "Jumps", text: (v) => digits(v, 1), least: true },
    { key: "coefficients_per_patch", name: "Numbers", text: (v) => v ? digits(v, 1) : "–", least: true },
    { key: "model_bytes", name: "Size", text: bytes, least: true },
    { key: "drawing_bytes", name: "Drawn in", text: bytes, least: true },
    { key: "fit_ms_per_frame", name: "Fit, a frame", text: milliseconds, least: true },
    { key: "fit_ms", name: "Fit, in all", text: milliseconds, least: true },
    { key: "render_ms_per_view", name: "Draw, a view", text: milliseconds, least: true },
  ];
  const shapes = ["circle", "rect", "triangle", "rectRot"];
  const palette = { light: ["#7d8797", "#2f7ed8", "#d9552c", "#d99a00", "#0f9d6b", "#8e5bd0"],
                    dark: ["#a3aebe", "#66a8f2", "#f2805a", "#f0bf3c", "#3fcf98", "#b68cf0"] };
  const families = [...new Set(data.results.map((row) => row.family))];
  const views = data.sessions.map((session) => ({ name: session.name, session,
    rows: data.results.filter((row) => row.session === session.name) }));
  if (views.length > 1 && data.averages.length > 0) {
    views.unshift({ name: "All recordings", rows: data.averages });
  }
  const state = { view: views[0], hidden: new Set(), active: null, sort: "psnr", descending: true };

  const css = (name) => getComputedStyle(root).getPropertyValue(name).trim();
  const colour = (family) => {
    const list = palette[root.dataset.theme];
    return list[families.indexOf(family) % list.length];
  };
  const shown = () => state.view.rows.filter((row) => !state.hidden.has(row.family));

  // Names beside the marks of the front, and of whatever is pointed at, where there is room.
  const names = {
    id: "names",
    afterDatasetsDraw(chart) {
      const { ctx, chartArea: area } = chart;
      const taken = [];
      const marks = [];
      chart.data.datasets.forEach((dataset, index) => {
        if (!dataset.rows) return;
        chart.getDatasetMeta(index).data.forEach((point, i) => marks.push({
          x: point.x, y: point.y, row: dataset.rows[i],
          weight: (dataset.rows[i].candidate === state.active ? 2 : 0) + (dataset.rows[i][dataset.front] ? 1 : 0) }));
      });
      ctx.save();
      ctx.font = `500 12px ${getComputedStyle(document.body).fontFamily}`;
      ctx.textBaseline = "middle";
      ctx.lineWidth = 3;
      ctx.lineJoin = "round";
      ctx.strokeStyle = css("--card");
      marks.sort((a, b) => b.weight - a.weight);
      for (const mark of marks) {
        const width = ctx.measureText(mark.row.label).width;
        const places = [[11, 0], [-11 - width, 0], [-width / 2, -16], [-width / 2, 16], [9, -13],
                        [9, 13], [-9 - width, -13], [-9 - width, 13]];
        const spot = places.map(([dx, dy]) => ({ x: mark.x + dx, y: mark.y + dy })).find(({ x, y }) =>
          x >= area.left && x + width <= area.right + 8 && y - 8 >= area.top && y + 8 <= area.bottom &&
          !taken.some((t) => x < t.x + t.width + 4 && t.x < x + width + 4 && Math.abs(t.y - y) < 15) &&
          !marks.some((m) => m !== mark && m.x > x - 7 && m.x < x + width + 7 && Math.abs(m.y - y) < 13));
        if (!spot) continue;
        taken.push({ ...spot, width });
        ctx.fillStyle = mark.weight > 0 ? css("--ink") : css("--soft");
        ctx.strokeText(mark.row.label, spot.x, spot.y);
        ctx.fillText(mark.row.label, spot.x, spot.y);
      }
      ctx.restore();
    },
  };

  const datasets = (cost) => {
    const rows = shown();
    const front = rows.filter((row) => row[cost.front]).sort((a, b) => a[cost.key] - b[cost.key]);
    const point = (row) => ({ x: row[cost.key], y: row.psnr });
    const marks = families.filter((family) => !state.hidden.has(family)).map((family) => {
      const own = rows.filter((row) => row.family === family);
      const size = (extra) => own.map((row) => (row.candidate === state.active ? 9 : 6) + extra);
      return { rows: own, front: cost.front, data: own.map(point), showLine: false,
               pointStyle: shapes[families.indexOf(family) % shapes.length],
               pointRadius: size(0), pointHoverRadius: size(2), hitRadius: 6, pointBorderWidth: 2,
               pointBorderColor: colour(family), pointHoverBorderColor: colour(family),
               pointBackgroundColor: own.map((row) => row[cost.front] ? colour(family) : css("--card")),
               pointHoverBackgroundColor: own.map((row) => row[cost.front] ? colour(family) : css("--card")) };
    });
    return [...marks, { data: front.map(point), showLine: true, borderColor: css("--front") + "66",
                        borderWidth: 1.5, pointRadius: 0, pointHitRadius: 0, order: 9 }];
  };

  // A log axis of Chart.js offers nine ticks a decade and both its ends: keep 1, 2 and 5, and
  // 3 and 7 where the axis is short.
  const pick_ticks = (axis) => {
    const leads = axis.max / axis.min < 8 ? [1, 2, 3, 5, 7] : [1, 2, 5];
    axis.ticks = axis.ticks.filter(({ value }) => {
      const lead = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
      return leads.some((round) => Math.abs(lead - round) < 1e-6);
    });
  };

  const range = (cost) => {
    const values = state.view.rows.map((row) => row[cost.key]);
    return { min: Math.min(...values) / 1.5, max: Math.max(...values) * 1.5 };
  };

  const options = (cost) => ({
    animation: false, maintainAspectRatio: false, responsive: true,
    interaction: { mode: "nearest", intersect: true },
    onHover: (event, items, chart) => {
      const dataset = items.length ? chart.data.datasets[items[0].datasetIndex] : null;
      activate(dataset && dataset.rows ? dataset.rows[items[0].index].candidate : null);
    },
    scales: {
      x: { type: "logarithmic", ...range(cost), grid: { color: css("--rule"), drawBorder: false },
           afterBuildTicks: pick_ticks,
           ticks: { color: css("--soft"), maxRotation: 0, autoSkipPadding: 14, callback: (v) => cost.text(v) } },
      y: { grace: "12%", grid: { color: css("--rule"), drawBorder: false }, ticks: { color: css("--soft") },
           title: { display: true, text: "PSNR, dB", color: css("--soft") } },
    },
    plugins: {
      legend: { display: false },
      tooltip: {
        filter: (item) => item.dataset.rows !== undefined,
        backgroundColor: css("--ink"), titleColor: css("--paper"), bodyColor: css("--paper"),
        padding: 12, displayColors: false, cornerRadius: 8, titleMarginBottom: 8,
        callbacks: {
          title: (items) => items.length ? items[0].dataset.rows[items[0].dataIndex].label : "",
          label: (item) => {
            const row = item.dataset.rows[item.dataIndex];
            return columns.slice(1).map((column) => `${column.name.split(",")[0]}${
              column.name.includes(", a") ? column.name.slice(column.name.indexOf(",")) : ""}: ${
              column.text(row[column.key])}`);
          },
        },
      },
    },
  });

  const charts = costs.map((cost) => ({ cost, chart: null }));
  const draw_charts = () => {
    for (const entry of charts) {
      if (entry.chart) entry.chart.destroy();
      entry.chart = new Chart(byId(entry.cost.canvas), {
        type: "scatter", data: { datasets: datasets(entry.cost) }, options: options(entry.cost), plugins: [names] });
    }
  };

  // Whatever is pointed at stands out everywhere.
  const activate = (candidate) => {
    if (candidate === state.active) return;
    state.active = candidate;
    for (const { chart } of charts) {
      for (const dataset of chart.data.datasets) {
        if (dataset.rows) dataset.pointRadius = dataset.rows.map((row) => row.candidate === candidate ? 9 : 6);
      }
      chart.update("none");
    }
    for (const line of byId("table").tBodies[0].rows) {
      line.classList.toggle("active", line.dataset.candidate === candidate);
    }
  };

  const sort_by = (column) => {
    state.descending = state.sort === column.key ? !state.descending : !column.least;
    state.sort = column.key;
    draw_table();
    byId("table").querySelector("th[aria-sort] button").focus();
  };

  const draw_table = () => {
    const table = byId("table");
    table.replaceChildren();
    const head = table.createTHead().insertRow();
    for (const column of columns) {
      const cell = make("th", undefined, head);
      cell.scope = "col";
      if (column.key === state.sort) cell.ariaSort = state.descending ? "descending" : "ascending";
      make("button", column.name, cell).addEventListener("click", () => sort_by(column));
    }
    const sign = state.descending ? -1 : 1;
    const rows = [...state.view.rows].sort((a, b) => sign * (typeof a[state.sort] === "string"
      ? a[state.sort].localeCompare(b[state.sort]) : a[state.sort] - b[state.sort]));
    const best = Object.fromEntries(columns.slice(1).map((column) => [column.key,
      column.least ? Math.min(...rows.map((row) => row[column.key] || Infinity))  // 0: there is none
                   : Math.max(...rows.map((row) => row[column.key]))]));
    const body = table.createTBody();
    for (const row of rows) {
      const line = body.insertRow();
      line.dataset.candidate = row.candidate;
      line.classList.toggle("off", state.hidden.has(row.family));
      line.addEventListener("pointerenter", () => activate(row.candidate));
      line.addEventListener("pointerleave", () => activate(null));
      for (const column of columns) {
        const cell = line.insertCell();
        if (column.key === "label") {
          make("i", undefined, cell).style.setProperty("--dot", colour(row.family));
          make("b", row.label, cell);
          if (data.advice && data.advice.candidate === row.candidate) make("span", "advised", cell).className = "tag";
        } else {
          cell.textContent = column.text(row[column.key]);
          cell.classList.toggle("best", row[column.key] === best[column.key]);
        }
      }
    }
  };

  const draw_tabs = () => {
    const tabs = byId("sessions");
    tabs.replaceChildren();
    tabs.hidden = views.length < 2;
    for (const view of views) {
      const tab = make("button", view.name, tabs);
      tab.type = "button";
      tab.ariaPressed = String(view === state.view);
      tab.addEventListener("click", () => { state.view = view; draw(); });
    }
    const { session, rows } = state.view;
    byId("facts").textContent = session
      ? `${session.name}: ${digits(session.fitted_frames, 0)} frames fitted, ${
        digits(session.held_out_views, 0)} views never seen${
        session.has_own_held_out ? " (recorded apart)" : " (frames kept out)"}, ${
        digits(rows.length ? rows[0].patches : 0, 0)} patches, ${digits(rows.length ? rows[0].samples : 0, 0)} samples`
      : `Means over ${views.length - 1} recordings`;
  };

  const draw_families = () => {
    const group = byId("families");
    group.replaceChildren();
    for (const family of families) {
      const button = make("button", undefined, group);
      button.type = "button";
      button.ariaPressed = String(!state.hidden.has(family));
      make("i", undefined, button).style.setProperty("--dot", colour(family));
      button.append(family);
      button.addEventListener("click", () => {
        if (!state.hidden.delete(family)) state.hidden.add(family);
        draw();
      });
    }
  };

  const draw = () => { draw_tabs(); draw_families(); draw_charts(); draw_table(); };

  const dark = matchMedia("(prefers-color-scheme: dark)");
  const set_theme = (name) => { root.dataset.theme = name; root.style.colorScheme = name; draw(); };
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  byId("advice").textContent = data.advice ? data.advice.sentence : "";
  byId("left-out").textContent = data.left_out.map((left) =>
    `Left out: ${left.candidate} on ${left.session}: ${left.reason}.`).join(" ");
  byId("theme").addEventListener("click", () => set_theme(root.dataset.theme === "dark" ? "light" : "dark"));
  dark.addEventListener("change", () => set_theme(dark.matches ? "dark" : "light"));
  set_theme(dark.matches ? "dark" : "light");
})();
