# SPDX-License-Identifier: MIT
"""Draws accuracy against fit time, render time and bytes from compare.csv.

    python3 charts.py compare.csv FOLDER

writes fit-time, render-time and bytes, each as .png and .svg. Exit status 3: no matplotlib.
"""
import csv
import math
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(3)
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib import patheffects
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

INK, SOFT, RULE, PAPER, FRONT = "#1d2530", "#667081", "#e3e6eb", "#ffffff", "#1d2530"
COLOURS = ["#8a93a3", "#2f7ed8", "#d9552c", "#e0a100", "#0f9d6b", "#8e5bd0", "#c2407f"]
MARKERS = ["o", "s", "^", "D", "*", "P", "X"]
COLUMNS = 3


def bytes_text(value, _=None):
    for unit, size in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if value >= size:
            return f"{value / size:g} {unit}"
    return f"{value:g} B"


def ms_text(value, _=None):
    return f"{value / 1000:g} s" if value >= 1000 else f"{value:g} ms"


CHARTS = [
    ("fit-time", "fit_ms_per_frame", "front_fit_time", "Time to fit a frame (CPU)", ms_text),
    ("render-time", "render_ms_per_view", "front_render_time", "Time to draw a view (CPU)", ms_text),
    ("bytes", "model_bytes", "front_bytes", "Size of the model file", bytes_text),
]


def read_rows(path):
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        return list(csv.DictReader(file))


def style():
    plt.rcParams.update({
        "font.family": "sans-serif",
        "font.sans-serif": ["Inter", "Helvetica Neue", "Arial", "Liberation Sans", "DejaVu Sans"],
        "font.size": 10, "text.color": INK, "axes.labelcolor": SOFT, "axes.edgecolor": RULE,
        "xtick.color": SOFT, "ytick.color": SOFT, "axes.spines.top": False,
        "axes.spines.right": False, "axes.spines.left": False, "svg.fonttype": "none",
        "svg.hashsalt": "sheen", "figure.facecolor": PAPER,
    })


def place_labels(figure, axes, points):
    """Puts each name where it hides least: beside, above or below its point."""
    renderer = figure.canvas.get_renderer()
    frame = axes.get_window_extent(renderer)
    marks = [axes.transData.transform((x, y)) for x, y, _ in points]
    taken = []
    places = [(a * r, b * r) for r in (9, 16, 24) for a, b in
              ((1, 0), (-1, 0), (0, 1), (0, -1), (.75, .75), (.75, -.75), (-.75, .75), (-.75, -.75))]
    for (x, y, name), mark in sorted(zip(points, marks), key=lambda p: p[1][1], reverse=True):
        best = None
        for dx, dy in places:
            text = axes.annotate(
                name, (x, y), xytext=(dx, dy), textcoords="offset points", fontsize=8.5, color=INK,
                ha="left" if dx > 0 else "right" if dx < 0 else "center",
                va="bottom" if dy > 0 else "top" if dy < 0 else "center",
                path_effects=[patheffects.withStroke(linewidth=2.5, foreground=PAPER)])
            box = text.get_window_extent(renderer)
            cost = math.hypot(dx, dy) / 40
            cost += 6 * sum(box.overlaps(other) for other in taken)
            cost += 3 * sum(box.x0 - 4 < a < box.x1 + 4 and box.y0 - 4 < b < box.y1 + 4
                            for a, b in marks)
            cost += 8 * (box.x0 < frame.x0 or box.x1 > frame.x1 + 12 or box.y0 < frame.y0
                         or box.y1 > frame.y1)
            if best is None or cost < best[0]:
                if best is not None:
                    best[1].remove()
                best = (cost, text, box)
            else:
                text.remove()
        taken.append(best[2])


def draw_front(axes, rows, cost, front):
    line = sorted((float(row[cost]), float(row["psnr"])) for row in rows if row[front] == "1")
    axes.plot(*zip(*line), color=FRONT, linewidth=1.2, alpha=.45, zorder=1, solid_joinstyle="round",
              label="Pareto front")


def draw_panel(axes, rows, families, cost, front, format_cost):
    draw_front(axes, rows, cost, front)
    for index, family in enumerate(families):
        for row in (row for row in rows if row["family"] == family):
            on_front = row[front] == "1"
            colour = COLOURS[index % len(COLOURS)]
            axes.scatter(float(row[cost]), float(row["psnr"]), s=64, zorder=3, linewidths=1.6,
                         marker=MARKERS[index % len(MARKERS)], edgecolors=colour,
                         facecolors=colour if on_front else PAPER)
    axes.set_xscale("log")
    axes.set_title(rows[0]["session"], loc="left", fontsize=11, fontweight="bold", pad=10)
    axes.grid(color=RULE, linewidth=.8)
    axes.set_axisbelow(True)
    axes.tick_params(length=0, which="both")
    axes.margins(x=.16, y=.12)
    costs = [float(row[cost]) for row in rows]
    decades = math.log10(max(costs) / min(costs))
    subs = (1, 2, 5) if decades < 1.4 else (1, 3) if decades < 2.4 else (1,)
    axes.xaxis.set_major_locator(LogLocator(subs=subs, numticks=8))
    axes.xaxis.set_major_formatter(FuncFormatter(format_cost))
    axes.xaxis.set_minor_formatter(NullFormatter())


def draw_legend(figure, families, columns):
    handles = [plt.Line2D([], [], linestyle="", marker=MARKERS[i % len(MARKERS)], markersize=8,
                          color=COLOURS[i % len(COLOURS)], label=family)
               for i, family in enumerate(families)]
    handles.append(plt.Line2D([], [], linestyle="", marker="o", markersize=8, markerfacecolor=PAPER,
                              color=SOFT, label="hollow: another is cheaper and better"))
    handles.append(plt.Line2D([], [], color=FRONT, alpha=.45, label="Pareto front"))
    figure.legend(handles=handles, loc="lower center", ncol=columns, frameon=False, fontsize=9,
                  labelcolor=INK)


def draw_chart(rows, folder, name, cost, front, title, format_cost):
    sessions = list(dict.fromkeys(row["session"] for row in rows))
    families = list(dict.fromkeys(row["family"] for row in rows))
    columns = min(COLUMNS, len(sessions))
    lines = math.ceil(len(sessions) / columns)
    width, height = max(7.2, 5 * columns), 4.2 * lines + 1.6
    figure, grid = plt.subplots(lines, columns, figsize=(width, height), squeeze=False)
    figure.subplots_adjust(left=.75 / width, right=1 - .3 / width, top=1 - 1.05 / height,
                           bottom=1.55 / height, wspace=.2, hspace=.42)
    figure.text(.3 / width, 1 - .36 / height, f"Accuracy on views never seen against {title[0].lower()}"
                f"{title[1:]}", fontsize=14, fontweight="bold", va="center")
    panels = grid.flatten()
    for axes, session in zip(panels, sessions):
        draw_panel(axes, [row for row in rows if row["session"] == session], families, cost, front,
                   format_cost)
        axes.set_xlabel(title + ", log scale")
    for axes in grid[:, 0]:
        axes.set_ylabel("PSNR, dB")
    for axes in panels[len(sessions):]:
        axes.set_visible(False)
    draw_legend(figure, families, 3 if columns == 1 else 4)
    figure.canvas.draw()
    for axes, session in zip(panels, sessions):
        place_labels(figure, axes, [(float(row[cost]), float(row["psnr"]), row["label"])
                                    for row in rows if row["session"] == session])
    for ending in ("png", "svg"):
        figure.savefig(os.path.join(folder, f"{name}.{ending}"), dpi=160,
                       metadata={"Date": None} if ending == "svg" else None)
    plt.close(figure)


def main():
    rows = read_rows(sys.argv[1])
    style()
    for name, cost, front, title, format_cost in CHARTS:
        draw_chart(rows, sys.argv[2], name, cost, front, title, format_cost)


if __name__ == "__main__":
    main()
