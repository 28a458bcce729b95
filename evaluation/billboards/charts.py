# SPDX-License-Identifier: MIT
"""Draws the average error of billboards against distance from billboards.csv.

    python3 charts.py billboards.csv FOLDER

writes billboards.png and .svg. Exit status 3: no matplotlib.
"""
import csv
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(3)
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, NullFormatter

INK, SOFT, RULE = "#1d2530", "#667081", "#e3e6eb"
COLOURS = {"0": "#2f7ed8", "40": "#0f9d6b", "60": "#e0a100", "90": "#d9552c"}
NAMES = {"0": "orthographic", "40": "40 degrees", "60": "60 degrees", "90": "90 degrees"}


def curve(rows, view, bake, outlines, value):
    return zip(*[(float(row["distance"]), float(row[value])) for row in rows
                 if (row["view_fov"], row["bake_fov"], row["outlines"]) == (view, bake, outlines)])


def main():
    with open(sys.argv[1], newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    rows = [row for row in rows if row["pixels"] == rows[0]["pixels"]]
    plt.rcParams.update({"font.size": 10, "text.color": INK, "axes.labelcolor": SOFT,
                         "axes.edgecolor": RULE, "xtick.color": SOFT, "ytick.color": SOFT,
                         "axes.spines.top": False, "axes.spines.right": False,
                         "svg.hashsalt": "sheen"})
    panels = [("hard", "average", "Hard outlines, as in the paper"),
              ("antialiased", "average", "Antialiased"), ("hard", "paper_average", "The paper")]
    views = list(dict.fromkeys(row["view_fov"] for row in rows))
    figure, grid = plt.subplots(len(panels), len(views), figsize=(12, 9.6), sharex=True,
                                sharey="row", squeeze=False)
    for line, (outlines, value, title) in zip(grid, panels):
        for axes, view in zip(line, views):
            for bake, colour in COLOURS.items():
                axes.plot(*curve(rows, view, bake, outlines, value), color=colour, marker="o",
                          markersize=3.5, linewidth=1.4, label=NAMES[bake])
            axes.set_xscale("log", base=2)
            axes.set_yscale("log")
            axes.set_title(f"{title}: view of {view} degrees", loc="left", fontsize=10, color=INK)
            axes.grid(color=RULE, linewidth=.8)
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.yaxis.set_minor_formatter(NullFormatter())
    for axes in grid[-1]:
        axes.set_xlabel("distance, multiples of the one that just fits")
    for axes in grid[:, 0]:
        axes.set_ylabel("average error, 0 to 765")
    figure.legend(*grid[0][0].get_legend_handles_labels(), loc="lower center", ncol=4,
                  frameon=False, title="frames baked with")
    figure.tight_layout(rect=(0, .06, 1, 1))
    for ending in ("png", "svg"):
        figure.savefig(os.path.join(sys.argv[2], f"billboards.{ending}"), dpi=110,
                       metadata={"Date": None} if ending == "svg" else None)


if __name__ == "__main__":
    main()
