#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws performance-scale.svg and performance-stages.svg from the CSV files of scale.py and
pipeline.py, those that are there, and prints the slopes of the curves.

Usage: plots.py [CSV FOLDER, default out/bench] [FIGURE FOLDER, default docs/figures]
Needs Debian's python3-matplotlib.
"""
import csv
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

SINGULAR = {"vertices": "vertex", "views": "view"}
COLOURS = {"quadtree": "#1f5fa8", "sparse": "#1e8a3c"}
MARKERS = {"quadtree": "o", "sparse": "s"}
STAGES = {"decode": "#8e5ea2", "pose": "#c0392b", "visibility": "#d9770b", "sample": "#f5c26b",
          "fit": "#1f5fa8"}

plt.rcParams.update({
    "font.size": 11, "axes.titlesize": 12, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.7, "axes.axisbelow": True,
    "lines.linewidth": 2.0, "lines.markersize": 6, "legend.frameon": False, "svg.fonttype": "none",
    "svg.hashsalt": "sheen",
})


def read(folder, name):
    path = folder / name
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def by_fitter(rows):
    groups = {}
    for row in rows:
        groups.setdefault(row["fitter"], []).append(row)
    return groups


def exponent(xs, ys):
    """Slope of the straight line through log y over log x."""
    lx = [math.log(x) for x in xs]
    ly = [math.log(y) for y in ys]
    mx, my = sum(lx) / len(lx), sum(ly) / len(ly)
    return sum((a - mx) * (b - my) for a, b in zip(lx, ly)) / sum((a - mx) ** 2 for a in lx)


def draw(axes, rows, x, y, title, label):
    for fitter, group in by_fitter(rows).items():
        xs = [float(row[x]) for row in group]
        ys = [float(row[y]) for row in group]
        axes.plot(xs, ys, color=COLOURS.get(fitter), marker=MARKERS.get(fitter, "^"), label=fitter)
        print(f"{title}, {fitter}: {label} grows as {x}^{exponent(xs, ys):.2f}, "
              f"{(ys[-1] - ys[0]) / (xs[-1] - xs[0]):.3g} per {SINGULAR[x]}, {ys[-1]:.4g} at {xs[-1]:.0f}")
    axes.set(title=title, xlabel=x, ylabel=label, xscale="log", yscale="log")
    axes.legend()


def draw_scale(source, target):
    vertices, views = read(source, "scale-vertices.csv"), read(source, "scale-views.csv")
    if not vertices or not views:
        return
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.5), layout="constrained")
    draw(axes[0][0], vertices, "vertices", "peak_rss_mb", "Memory against size", "peak memory, MB")
    draw(axes[0][1], vertices, "vertices", "fit_ms", "Fit against size", "CPU ms a view")
    draw(axes[1][0], views, "views", "peak_rss_mb", "Memory against views", "peak memory, MB")
    draw(axes[1][1], views, "views", "fit_ms", "Fit against views", "CPU ms a view")
    for plot in axes[1]:
        plot.set_ylim(bottom=plot.get_ylim()[0] / 4, top=plot.get_ylim()[1] * 4)
    figure.savefig(target / "performance-scale.svg", metadata={"Date": None})


def draw_stages(source, target):
    rows = read(source, "pipeline.csv")
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(10, 0.42 * len(rows) + 1.2), layout="constrained")
    names = [f"{int(row['vertices']) // 1000}K {row['scene']}, {row['fitter']}" for row in rows]
    left = [0.0] * len(rows)
    for stage, colour in STAGES.items():
        widths = [float(row[stage]) for row in rows]
        axes.barh(names, widths, left=left, color=colour, label=stage, height=0.7)
        left = [a + b for a, b in zip(left, widths)]
    axes.set(xlabel="milliseconds a frame, medians of CPU time")
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.legend(ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    figure.savefig(target / "performance-stages.svg", metadata={"Date": None})


def main():
    source = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/bench")
    target = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/figures")
    target.mkdir(parents=True, exist_ok=True)
    draw_scale(source, target)
    draw_stages(source, target)


if __name__ == "__main__":
    main()
