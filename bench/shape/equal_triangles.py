#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The mesh that `sheen mesh` makes of a session against its true mesh, at equal numbers of triangles.

Of every SESSION, which names its true mesh, a copy without it is measured (every fifth frame held
out). The finer of both meshes is decimated to the coarser one's triangles, a light field is made on
each, and both are compared with the held-out frames over the true mesh's silhouette.

Usage: equal_triangles.py SESSION... [--sheen build/sheen] [--decimate build/bench/decimate] [-o out/shape]
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys

HOLD_OUT = ["--hold-out", "5"]
HEAD = """| session | triangles own / true | own | true | equal count | own | true | lost | CPU s |
|---|---|---:|---:|---|---:|---:|---:|---:|"""


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sessions", nargs="+", type=pathlib.Path)
    parser.add_argument("--sheen", default="build/sheen")
    parser.add_argument("--decimate", default="build/bench/decimate")
    parser.add_argument("-o", "--output", default="out/shape", type=pathlib.Path)
    return parser.parse_args()


def call(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    return done.stdout


def with_mesh(session, mesh, folder):
    """The session with another mesh, or none, in the board's frame."""
    folder.mkdir(parents=True, exist_ok=True)
    document = json.loads((session / "session.json").read_text())
    true_mesh = document.pop("object")["mesh"]
    for file in session.iterdir():
        link = folder / file.name
        if file.name not in ("session.json", true_mesh) and not link.exists():
            link.symlink_to(file.resolve())
    if mesh:
        (folder / "mesh.ply").write_bytes(mesh.read_bytes())
        identity = [float(row == column) for row in range(4) for column in range(4)]
        document["object"] = {"mesh": "mesh.ply", "T_stage_object": identity}
    (folder / "session.json").write_text(json.dumps(document))
    return folder


class Comparison:
    def __init__(self, session, chosen):
        self.session, self.chosen = session, chosen
        self.folder = chosen.output / session.resolve().name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.truth = self.folder / "true.ply"
        self.decimated(session, 0, self.truth)
        self.judge = with_mesh(session, self.truth, self.folder / "judge")

    def decimated(self, source, triangles, output):
        return int(call([self.chosen.decimate, source, "-o", output, "--triangles", triangles]))

    def measure(self):
        """Makes the own mesh. Returns CPU seconds, or why there is none."""
        bare = with_mesh(self.session, None, self.folder / "bare")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([self.chosen.sheen, "mesh", bare, "-o", self.folder / "own.ply", "--force", "--quiet"]
                              + HOLD_OUT, capture_output=True, text=True)
        if done.returncode == 2:
            return None, done.stderr.strip()
        if done.returncode != 0:
            sys.exit(done.stderr.strip())
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, None

    def psnr(self, mesh):
        model = self.folder / "model.glb"
        fitted = with_mesh(self.session, mesh, self.folder / "fitted")
        call([self.chosen.sheen, "replay", fitted, "-o", model, "--quiet"] + HOLD_OUT)
        report = call([self.chosen.sheen, "evaluate", model, self.judge, "--json", "--quiet"] + HOLD_OUT)
        return json.loads(report)["mean"]["psnr"]

    def row(self):
        name = self.session.resolve().name
        seconds, refusal = self.measure()
        if refusal:
            return f"| {name} | - | refused | {self.psnr(self.truth):.2f} | | | | | |\n\n{refusal}"
        meshes = {"own": self.folder / "own.ply", "true": self.truth}
        counts = {which: self.decimated(mesh, 0, self.folder / "same.ply") for which, mesh in meshes.items()}
        full = {which: self.psnr(mesh) for which, mesh in meshes.items()}
        fewest = min(counts.values())
        equal = {}
        for which, mesh in meshes.items():
            if counts[which] == fewest:
                equal[which] = full[which]
                continue
            reached = self.decimated(mesh, fewest, self.folder / "equal.ply")
            equal[which] = self.psnr(self.folder / "equal.ply")
            fewest = max(fewest, reached)
        return (f"| {name} | {counts['own']} / {counts['true']} | {full['own']:.2f} | {full['true']:.2f} "
                f"| {fewest} | {equal['own']:.2f} | {equal['true']:.2f} | {equal['true'] - equal['own']:+.2f} | {seconds:.0f} |")


def main():
    chosen = options()
    print(HEAD)
    for session in chosen.sessions:
        print(Comparison(session, chosen).row(), flush=True)


if __name__ == "__main__":
    main()
