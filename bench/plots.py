#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the figures of docs/accuracy.md from the CSV files of the bench's programs.

Usage: plots.py [CSV FOLDER, default out/bench] [FIGURE FOLDER, default docs/figures]
Needs Debian's python3-matplotlib.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FixedLocator, NullLocator, ScalarFormatter  # noqa: E402

# One colour for each family in every figure: red the paper, blue the same with a ridge, green what
# grows by itself, orange spherical harmonics, grey what does not look at directions.
# name in the CSV: (label, colour, line, marker)
STYLES = {
    "quadtree 16x3 faithful": ("quadtree 16x3, paper", "#c0392b", "-", "o"),
    "adaptive 16x3 faithful": ("adaptive 16x3, paper", "#e57368", "--", "s"),
    "batch 16x3 faithful": ("batch 16x3, paper", "#8c1d13", ":", "D"),
    "quadtree 16x3 ridge": ("quadtree 16x3, ridge", "#1f5fa8", "-", "o"),
    "adaptive 16x3 ridge": ("adaptive 16x3, ridge", "#5b9bd5", "--", "s"),
    "batch 16x3 ridge": ("batch 16x3, ridge", "#0d3b6e", ":", "D"),
    "quadtree 64x3 ridge": ("quadtree 64x3, ridge", "#2aa1b3", "-", "^"),
    "batch 16x1 ridge": ("batch 16x1, ridge", "#9fb7d1", "-.", "v"),
    "batch 16x6 ridge": ("batch 16x6, ridge", "#4b7bb5", "-.", "P"),
    "sh 1": ("harmonics, degree 1", "#f5c26b", "-.", "<"),
    "sh 2": ("harmonics, degree 2", "#eda034", "--", "<"),
    "sh 3": ("harmonics, degree 3", "#d9770b", "-", "<"),
    "sh 3 ridge .01": ("harmonics 3, ridge .01", "#a35a00", ":", ">"),
    "mean": ("mean colour", "#7f7f7f", "-", "x"),
    "sparse": ("sparse", "#1e8a3c", "-", "*"),
    "nearest-views": ("nearest views", "#8e5ea2", "--", "h"),
}
# What line charts show: the rest is close to one of these and stands in the tables.
SHOWN = ["quadtree 16x3 faithful", "adaptive 16x3 faithful", "quadtree 16x3 ridge",
         "quadtree 64x3 ridge", "sh 3", "sh 3 ridge .01", "mean", "nearest-views", "sparse"]

plt.rcParams.update({
    "figure.dpi": 160, "savefig.dpi": 160, "font.size": 12, "axes.titlesize": 13,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.color": "#dddddd", "grid.linewidth": 0.7, "axes.axisbelow": True,
    "lines.linewidth": 2.0, "lines.markersize": 6, "legend.frameon": False,
})


def read(folder, name):
    with open(folder / name, newline="") as file:
        return list(csv.DictReader(file))


def style(method):
    return STYLES.get(method, (method, "#444444", "-", "o"))


def draw(axes, method, xs, ys):
    label, colour, line, marker = style(method)
    size = 11 if method == "sparse" else 6
    axes.plot(xs, ys, line, marker=marker, color=colour, label=label, markersize=size,
              linewidth=3 if method == "sparse" else 2)


def shown(rows):
    there = {row["method"] for row in rows}
    return [method for method in SHOWN if method in there]


def plain_ticks(axis, values):
    axis.set_major_locator(FixedLocator(values))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(ScalarFormatter())


def legend_below(figure, axes, columns):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=columns)


def save(figure, folder, name, bottom):
    figure.tight_layout(rect=(0, bottom, 1, 1))
    figure.savefig(folder / name)
    plt.close(figure)
    print(folder / name)


def series(rows, method, views, setting, x, y):
    part = [row for row in rows
            if row["method"] == method and row["views"] == views and row["setting"] == setting]
    return [float(row[x]) for row in part], [float(row[y]) for row in part]


def value(rows, method, views, setting, samples, y):
    for row in rows:
        if (row["method"], row["views"], row["setting"], row["samples"]) == (
                method, views, setting, str(samples)):
            return float(row[y])
    return float("nan")


def error_against_samples(rows, folder):
    figure, panels = plt.subplots(1, 2, figsize=(10, 6), sharey=True)
    titles = {"uni": "scattered views", "arc": "three handheld arcs"}
    for axes, (views, title) in zip(panels, titles.items()):
        for method in shown(rows):
            draw(axes, method, *series(rows, method, views, "base", "samples", "rms"))
        axes.set(xscale="log", yscale="log", title=title, xlabel="samples per patch")
        plain_ticks(axes.xaxis, [4, 8, 16, 32, 64, 128, 256])
        plain_ticks(axes.yaxis, [0.03, 0.04, 0.05, 0.07, 0.1, 0.15, 0.2])
    panels[0].set_ylabel("RMS error, held-out directions")
    legend_below(figure, panels[0], 3)
    save(figure, folder, "error_against_samples.png", 0.19)


def stability(rows, folder):
    figure, panels = plt.subplots(2, 2, figsize=(10, 9.5))
    methods = shown(rows)
    # Worst values: which view sets send a model away from all colours there are.
    axes = panels[0][0]
    sets = ["uni", "gap", "arc", "clusters", "one-arc"]
    for method in methods:
        draw(axes, method, range(len(sets)),
             [value(rows, method, views, "base", 64, "worst95") for views in sets])
    axes.set(yscale="log", title="worst error before clamping", ylabel="95th percentile of patches")
    axes.set_xticks(range(len(sets)), sets)
    plain_ticks(axes.yaxis, [0.7, 1, 2, 4, 8])
    # What the missing sector costs.
    axes = panels[0][1]
    for idx, method in enumerate(reversed(methods)):
        label, colour, _, _ = style(method)
        axes.barh(idx, value(rows, method, "gap", "base", 64, "rms_in_gap"), color=colour)
    axes.set_yticks(range(len(methods)), [style(method)[0] for method in reversed(methods)])
    axes.set(title="RMS in an unseen sector")
    axes.grid(axis="y", visible=False)
    # Outliers and pose errors.
    sweeps = [
        (panels[1][0], "uni", "outliers, scattered views", "outliers, %",
         [(0, "base"), (2, "outliers 2 %"), (10, "outliers 10 %")]),
        (panels[1][1], "arc", "pose error, three handheld arcs", "pose error, degrees",
         [(0, "pose 0"), (0.5, "base"), (1.5, "pose 1.5"), (3, "pose 3")]),
    ]
    for axes, views, title, label, stops in sweeps:
        for method in methods:
            draw(axes, method, [x for x, _ in stops],
                 [value(rows, method, views, setting, 64, "rms") for _, setting in stops])
        axes.set(title=title, xlabel=label, ylabel="RMS error", ylim=(0, None))
    figure.suptitle("64 samples per patch, nine materials")
    legend_below(figure, panels[0][0], 3)
    save(figure, folder, "stability.png", 0.11)


def incremental(rows, folder):
    figure, panels = plt.subplots(1, 2, figsize=(10, 5.6), sharey=True)
    methods = [name for name in rows[0] if name != "images" and not name.endswith("(all samples)")]
    for axes, suffix, title in [(panels[0], " (all samples)", "against all 64 samples (the paper's)"),
                                (panels[1], "", "against held-out directions")]:
        for method in methods:
            draw(axes, method, [float(row["images"]) for row in rows],
                 [float(row[method + suffix]) for row in rows])
        axes.set(xscale="log", title=title, xlabel="images so far", ylim=(0, None))
        plain_ticks(axes.xaxis, [2, 4, 8, 16, 32, 64])
    panels[0].set_ylabel("RMS error")
    legend_below(figure, panels[0], 3)
    save(figure, folder, "incremental.png", 0.13)


def layouts(rows, folder):
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.8), sharey=True)
    names = ["grid", "jittered-grid", "disk", "jittered-disk"]
    constructions = ["quadtree 16x3 faithful", "adaptive 16x3 faithful", "quadtree 16x3 ridge"]
    for axes, views, title in [(panels[0], "uni", "scattered views"),
                               (panels[1], "arc", "three handheld arcs")]:
        width = 0.26
        for idx, construction in enumerate(constructions):
            label, colour, _, _ = style(construction)
            means = [next(float(row["mean"]) for row in rows
                          if (row["construction"], row["views"], row["layout"])
                          == (construction, views, layout)) for layout in names]
            axes.bar([k + (idx - 1) * width for k in range(4)], means, width, color=colour,
                     label=label)
        paper = [float(next(row["paper mean"] for row in rows if row["layout"] == layout))
                 for layout in names]
        axes.plot(range(4), paper, "k_", markersize=34, markeredgewidth=2, label="paper, Table 2")
        axes.set_xticks(range(4), [name.replace("-", "\n") for name in names])
        axes.set(title=title)
        axes.grid(axis="x", visible=False)
    panels[0].set_ylabel("RMS error, 64 views")
    legend_below(figure, panels[0], 4)
    save(figure, folder, "layouts.png", 0.09)


def pareto_front(points):
    """Methods with no other that has fewer numbers and a higher PSNR."""
    front = []
    best = float("-inf")
    for method, numbers, psnr in sorted(points, key=lambda point: (point[1], -point[2])):
        if psnr > best:
            front.append((method, numbers, psnr))
            best = psnr
    return front


def scene(rows, folder):
    figure, panels = plt.subplots(1, 2, figsize=(10, 6.6))
    for axes, environment in zip(panels, ["studio", "busy"]):
        points = [(row["method"], float(row["numbers"]), float(row["psnr_path"])) for row in rows
                  if (row["environment"], row["setting"], row["samples"])
                  == (environment, "base", "96")]
        front = pareto_front(points)
        axes.plot([x for _, x, _ in front], [y for _, _, y in front], color="#333333",
                  linewidth=1.2, linestyle="--", zorder=1, label="Pareto front")
        for method, x, y in points:
            label, colour, _, marker = style(method)
            on_front = any(method == name for name, _, _ in front)
            axes.scatter(x, y, s=260 if method == "sparse" else 90, color=colour, marker=marker,
                         label=label, zorder=3,
                         **({} if marker == "x" else
                            {"edgecolors": "black" if on_front else "none", "linewidths": 1.4}))
        axes.set(xscale="log", title=f"{environment} environment", xlabel="numbers per patch")
        plain_ticks(axes.xaxis, [3, 6, 12, 27, 48, 144, 576])
    panels[0].set_ylabel("PSNR in dB, held-out handheld walk")
    figure.suptitle("Scene, 70 % matt and 30 % glossy, 96 samples per patch")
    legend_below(figure, panels[0], 3)
    save(figure, folder, "scene_pareto.png", 0.23)


def main():
    source = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/bench")
    target = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/figures")
    target.mkdir(parents=True, exist_ok=True)
    stability_rows = read(source, "stability.csv")
    error_against_samples(stability_rows, target)
    stability(stability_rows, target)
    incremental(read(source, "paper_incremental.csv"), target)
    layouts(read(source, "paper_layouts.csv"), target)
    scene(read(source, "scene.csv"), target)


main()
