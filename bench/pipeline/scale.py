#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs build/bench/scale over sizes of the object and lengths of the recording.

One process for each size, so that its peak memory is its own. Writes scale-vertices.csv (every
size, --views views) and scale-views.csv (--vertices-of-views vertices, up to --most-views).

Usage: scale.py [--program build/bench/scale] [-o out/bench]
"""
import argparse
import csv
import io
import pathlib
import subprocess
import sys


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/bench/scale")
    parser.add_argument("-o", "--output", default="out/bench", type=pathlib.Path)
    parser.add_argument("--fitters", default="quadtree,sparse")
    parser.add_argument("--vertices", default="4000,16000,63000,250000,500000,1000000,2000000")
    parser.add_argument("--views", default=120, type=int, help="views at every size")
    parser.add_argument("--vertices-of-views", default=31000, type=int)
    parser.add_argument("--most-views", default=5000, type=int)
    return parser.parse_args()


def run(chosen, fitter, vertices, views):
    print(f"{fitter}: {vertices} vertices, {views} views", file=sys.stderr)
    done = subprocess.run([chosen.program, "--fitter", fitter, "--vertices", str(vertices),
                           "--views", str(views)], check=True, stdout=subprocess.PIPE, text=True)
    return list(csv.DictReader(io.StringIO(done.stdout)))


def write(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def main():
    chosen = options()
    fitters = chosen.fitters.split(",")
    sizes = [int(size) for size in chosen.vertices.split(",")]
    write(chosen.output / "scale-vertices.csv",
          [run(chosen, fitter, size, chosen.views)[-1] for fitter in fitters for size in sizes])
    write(chosen.output / "scale-views.csv",
          [row for fitter in fitters
           for row in run(chosen, fitter, chosen.vertices_of_views, chosen.most_views)])


if __name__ == "__main__":
    main()
