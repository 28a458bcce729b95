#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""One page with charts of a sweep of build/bench/stress: held-out dB against severity, and what was said.

    build/bench/stress --json stress.json
    bench/stress_page.py stress.json [PAGE, default stress.html]

Needs Debian's libjs-chart.js when it is made, nothing when it is looked at.
"""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIBRARY = pathlib.Path("/usr/share/javascript/chart.js/chart.min.js")

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Sheen: sessions under stress</title>
<style>
{{style}}
.charts { grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); }
td.wide { white-space: normal; min-width: 13em; text-align: left; }
th, td { padding-inline: .4em; }
</style>
</head>
<body>
<main>
  <header><p class="brand">sheen <span>stress</span></p></header>
  <h1>Where sessions fail</h1>
  <p id="facts" class="facts"></p>
  <section class="charts" id="charts" aria-label="Charts"></section>
  <p class="hint">Filled marks: the program said something that it does not say of the undamaged session, or refused frames.
    The grey line is the mean colours of the undamaged session: below it a light field is not worth its name. A refused session
    has no mark. Damages are explained in docs/stability-sessions.md.</p>
  <section class="table" aria-label="All figures" tabindex="0"><table id="table"></table></section>
</main>
<script type="application/json" id="data">{{data}}</script>
<script>{{library}}</script>
<script>
{{script}}
</script>
</body>
</html>
"""

SCRIPT = """
"use strict";
const rows = JSON.parse(document.getElementById("data").textContent);
const colours = {"detail": "#2563c9", "sparse": "#1e8a3c", "paper-quadtree": "#c0392b", "sh3": "#d9770b", "mean": "#7f7f7f"};
const names = Object.keys(rows.find((row) => !row.refusal).psnr_db);
const base = rows.find((row) => row.kind === "none") || null;
const kinds = [...new Set(rows.map((row) => row.kind))].filter((kind) => kind !== "none");
const style = getComputedStyle(document.documentElement);
const ink = style.getPropertyValue("--soft").trim(), rule = style.getPropertyValue("--rule").trim();
Chart.defaults.color = ink;
Chart.defaults.borderColor = rule;

document.getElementById("facts").textContent = base
  ? `Undamaged: ${names.map((name) => `${name} ${base.psnr_db[name].toFixed(1)} dB`).join(", ")}; ${base.posed} of ${base.frames} frames posed.`
  : "";

for (const kind of kinds) {
  const damaged = rows.filter((row) => row.kind === kind);
  const points = base ? [{...base, severity: 0}, ...damaged] : damaged;
  const figure = document.createElement("figure");
  figure.innerHTML = "<figcaption></figcaption><div><canvas></canvas></div>";
  figure.firstChild.textContent = `${kind} (${damaged[0].unit})`;
  document.getElementById("charts").append(figure);
  const datasets = names.map((name) => ({
    label: name, data: points.map((row) => row.refusal ? null : row.psnr_db[name]), spanGaps: false,
    borderColor: colours[name] || ink, borderWidth: 1.5, pointRadius: 4, pointBorderColor: colours[name] || ink,
    pointBackgroundColor: points.map((row) => row.said && row.said !== "nothing" ? colours[name] || ink : "transparent"),
  }));
  if (base) {
    datasets.push({label: "mean, undamaged", data: points.map(() => base.psnr_db.mean), borderColor: ink, borderWidth: 1,
      borderDash: [4, 4], pointRadius: 0});
  }
  new Chart(figure.querySelector("canvas"), {
    type: "line",
    data: {labels: points.map((row) => row.severity), datasets},
    options: {
      animation: false, maintainAspectRatio: false,
      scales: {y: {title: {display: true, text: "PSNR, dB"}}, x: {title: {display: true, text: damaged[0].unit}}},
      plugins: {
        legend: {labels: {boxWidth: 12}},
        tooltip: {callbacks: {afterBody: (items) => {
          const row = points[items[0].dataIndex];
          return [`${row.posed} posed, ${row.refused} refused`, row.refusal || `said: ${row.said}`];
        }}},
      },
    },
  });
}

const table = document.getElementById("table");
const cell = (line, text, isHead) => {
  const item = document.createElement(isHead ? "th" : "td");
  item.textContent = text;
  line.append(item);
  return item;
};
const number = (value, digits) => value === null ? "-" : value.toFixed(digits);
const head = table.createTHead().insertRow();
for (const title of ["kind", "severity", "posed", "refused", "rightly", "posed wrongly", "error mm", ...names.map((n) => `${n} dB`), "said", "words"]) {
  cell(head, title, true);
}
const body = table.createTBody();
for (const row of rows) {
  const line = body.insertRow();
  cell(line, row.kind);
  cell(line, `${row.severity} ${row.unit}`);
  for (const key of ["posed", "refused", "rightly_refused", "wrongly_posed"]) cell(line, row[key]);
  cell(line, number(row.pose_error_mm, 2));
  for (const name of names) cell(line, row.refusal ? "-" : number(row.psnr_db[name], 2));
  cell(line, row.said);
  cell(line, row.refusal || row.notes.join(" | ")).className = "wide";
}
"""


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not LIBRARY.exists():
        sys.exit(f"{LIBRARY} is missing; install libjs-chart.js")
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text())
    page = PAGE
    # The data last: nothing in it is taken for a mark.
    for mark, text in [("style", (ROOT / "evaluation/comparison/page.css").read_text()), ("library", LIBRARY.read_text()),
                       ("script", SCRIPT), ("data", json.dumps(rows).replace("<", "\\u003c"))]:
        page = page.replace("{{" + mark + "}}", text, 1)
    path = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "stress.html")
    path.write_text(page)
    print(f"written  {path}")


if __name__ == "__main__":
    main()
