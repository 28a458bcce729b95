#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""CPU and wall milliseconds a frame through the whole program, stage by stage.

Makes 1280x720 sessions by `sheen synth` (kept in --sessions, so a second run measures at once),
replays each with every fitter, and prints median and 95th percentile of every stage.

Usage: pipeline.py [--program build/sheen] [--sessions out/bench/sessions] [-o out/bench]
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

STAGES = ("decode", "pose", "visibility", "sample", "fit")
COLUMNS = (*STAGES, "cpu", "wall")


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/sheen", help="the sheen to measure")
    parser.add_argument("--sessions", default="out/bench/sessions", type=pathlib.Path,
                        help="folder that keeps the sessions")
    parser.add_argument("-o", "--output", default="out/bench", type=pathlib.Path,
                        help="folder for pipeline.csv")
    parser.add_argument("--vertices", default="4000,31000,150000,500000",
                        help="sizes, separated by commas")
    parser.add_argument("--scenes", default="matte,glossy", help="scenes of sheen synth")
    parser.add_argument("--fitters", default="quadtree,sparse", help="fitters of sheen replay, and detail (sparse beside a texture)")
    parser.add_argument("--frames", default=60, type=int, help="frames of a session")
    parser.add_argument("--threads", default=2, type=int, help="1: stages do not overlap")
    return parser.parse_args()


def session(chosen, scene, vertices):
    """Folder of a session; made where it is not there yet, with sheen's own progress bar."""
    folder = chosen.sessions / f"{scene}-{vertices}-{chosen.frames}"
    if not (folder / "session.json").exists():
        print(f"{folder}", file=sys.stderr)
        subprocess.run([chosen.program, "synth", scene, "-o", folder, "--size", "1280x720",
                        "--vertices", str(vertices), "--frames", str(chosen.frames),
                        "--samples", "2", "--held-out", "0"],
                       check=True, stdout=subprocess.DEVNULL)
    return folder


def measure(chosen, folder, fitter):
    """The replay's own report."""
    fit = ["--patches", "detail"] if fitter == "detail" else ["--fitter", fitter]
    with tempfile.TemporaryDirectory() as scratch:
        report = pathlib.Path(scratch) / "report.json"
        subprocess.run([chosen.program, "replay", folder, "-o", pathlib.Path(scratch) / "model.glb",
                        *fit, "--threads", str(chosen.threads), "--report", report],
                       check=True, stdout=subprocess.DEVNULL)
        return json.loads(report.read_text())


def row(scene, vertices, fitter, report):
    times = {**{stage: report["stage_ms"][stage] for stage in STAGES},
             "cpu": report["cpu_ms"], "wall": report["frame_ms"]}
    result = {"scene": scene, "vertices": vertices, "fitter": fitter,
              "samples": round(report["samples"] / max(report["frames"]["fitted"], 1)),
              "peak_rss_mb": round(report["peak_rss_bytes"] / 1e6)}
    for column in COLUMNS:
        result[column] = round(times[column]["median"], 2)
        result[column + "_p95"] = round(times[column]["p95"], 2)
    return result


def table(rows):
    lines = ["| scene | vertices | fitter | samples | " + " | ".join(COLUMNS) + " | peak MB |",
             "|" + "---|" * (len(COLUMNS) + 5)]
    for r in rows:
        times = " | ".join(f"{r[c]:.1f} ({r[c + '_p95']:.1f})" for c in COLUMNS)
        lines.append(f"| {r['scene']} | {r['vertices']} | {r['fitter']} | {r['samples']} | {times} "
                     f"| {r['peak_rss_mb']} |")
    return "\n".join(lines)


def main():
    chosen = options()
    rows = []
    for scene in chosen.scenes.split(","):
        for vertices in map(int, chosen.vertices.split(",")):
            folder = session(chosen, scene, vertices)
            for fitter in chosen.fitters.split(","):
                rows.append(row(scene, vertices, fitter, measure(chosen, folder, fitter)))
    chosen.output.mkdir(parents=True, exist_ok=True)
    with open(chosen.output / "pipeline.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    print(f"Milliseconds a frame, median (95th percentile); stages and cpu are CPU time, "
          f"{chosen.threads} threads\n")
    print(table(rows))


if __name__ == "__main__":
    main()
