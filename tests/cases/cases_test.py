#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs one of the input cases beside the repository and holds its outcome against its expected.txt.

Usage: cases_test.py PROGRAM SAMPLE CASES NAME. Exit code 77 where the case or a program that it needs
is missing.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77


def parts(output, mark="== "):
    """Heading -> the lines below it, for cases that try several things."""
    found, heading = {}, ""
    for line in output.splitlines():
        if line.startswith(mark):
            heading = line[len(mark):]
        found.setdefault(heading, []).append(line)
    return {name: "\n".join(lines) for name, lines in found.items()}


def psnrs(output):
    """Mean PSNR of every evaluation, dB."""
    return [float(value) for value in re.findall(r"^\w+ +\d+ +(\d+\.\d+) dB", output, re.M)]


class Check:
    """What is wrong with an output, collected."""

    def __init__(self, output):
        self.output = output
        self.faults = []

    def that(self, holds, fault):
        if not holds:
            self.faults.append(fault)

    def says(self, *words, where=None, name=""):
        text = self.output if where is None else where
        for word in words:
            self.that(re.search(word, text), f"{name or 'output'} lacks {word!r}")

    def silent(self, *words, where=None, name=""):
        text = self.output if where is None else where
        for word in words:
            self.that(not re.search(word, text), f"{name or 'output'} has {word!r}")


def board_millimetres(check):
    check.says("are the numbers millimetres", "are the numbers centimetres")
    check.silent("written", "exit 0")


def board_yaml_variants(check):
    tries = parts(check.output)
    posed = "frames   10 read, 10 posed"
    for name in ("apriltag_ros with standalone_tags beside the bundle", "family 36h11", "quoted family, CRLF",
                 "ids with leading zeros (008 is no octal number)", "BOM"):
        check.says(posed, where=tries[name], name=name)
    for name, word in {"apriltag_ros, standalone_tags only": "tag_bundles", "ROS 2 apriltag_ros": "tag_bundles",
                       "millimetres": "millimetres", "size with unit": "size .*0.04m",
                       "size measured inside the black border": "size", "decimal comma": "decimal comma",
                       "Kalibr checkerboard": "target_type",
                       "Kalibr aprilgrid, spacing in metres (border of another board)": "border",
                       "tab as indent": "line 5.*tabs"}.items():
        check.says("sheen: .*board.yaml: ", word, where=tries[name], name=name)
        check.silent(posed, where=tries[name], name=name)


def calibrate_folder(check):
    tries = parts(check.output)
    for name in ("plain", "AppleDouble ._IMG_0001.JPG beside", "folder, Thumbs.db",
                 "one photograph turned by EXIF 6, one by 3"):
        check.says(r"error +0\.\d+ px", where=tries[name], name=name)
    check.says("IMG_0099.JPG: is empty", where=tries["a picture of no bytes"])
    check.says("HEIC.*not read", "convert", where=tries["heic"], name="heic")


def camera_fisheye(check):
    found = psnrs(check.output)
    check.that(len(found) == 4, f"{len(found)} evaluations")
    # As good as the sample's own lens, but for one resampling of the images.
    for value in found:
        check.that(value > found[-1] - 0.7, f"{value} dB against {found[-1]} dB")


def camera_ros_yaml(check):
    check.that(len(re.findall(r"focal_px +\[576.0,577.152\]", check.output)) == 2, "not both read alike")


def capture_bad_device(check):
    for device in ("/dev/video0", "0", "/dev/null", "/dev/zero", "work/file.txt", "work",
                   "rtsp://127.0.0.1:9/stream", "/dev/video0,1"):
        line = re.findall(rf"^\[{re.escape(device)}\] (.*)$", check.output, re.M)
        check.that(len(line) == 1 and device in line[0].split("sheen: ", 1)[-1], f"{device}: {line}")
    check.silent("left behind", "exit 124", "exit 0\n.*exit 0\n")


def glb_quantized(check):
    tries = parts(check.output)
    for name in ("short", "short-normalized", "byte"):
        check.says("vertices 6 triangles 8 area 0.0173205", where=tries[name], name=name)
    check.says(r"259\.8 m across", where=tries["ushort14-mm"])
    check.silent("written", where=tries["ushort14-mm"])


def glb_quantized_normals(check):
    found = psnrs(check.output)
    check.that(len(found) == 3 and min(found) > 33.5, f"{found} dB")


def mesh_inside_out_open(check):
    found = psnrs(check.output)
    check.that(len(found) == 5 and min(found) > max(found) - 0.1 and found[0] > 32, f"{found} dB")
    check.that(len(re.findall("^note: ", check.output, re.M)) == 4, "not every turn is said")


def mjpeg_damaged(check):
    check.says("60 read, 60 posed", "60 more were damaged")


def photos_exif(check):
    found = psnrs(check.output)
    check.that(len(found) == 3 and len(set(found)) == 1, f"{found} dB")
    check.says("turned by 90 degrees", "turned by 180 degrees")


def ply_concave_polygon(check):
    check.that(len(re.findall(r"area 0\.0078 ", check.output)) == 2, "another area")


def ply_no_z(check):
    check.says("height.ply: its vertices have no z", "upper.ply: its vertices have no x")
    check.silent("exit 0")


def ply_tristrips(check):
    check.says('"triangles":8')


def poses_csv(check):
    tries = parts(check.output)
    for name in ("BOM before #", "BOM before a number", "tabs and trailing blank", "CRLF", "unsorted", "denormal",
                 "1e-400"):
        check.says("poses +12\n", where=tries[name], name=name)
    for name, word in {"commas": "line 2.*commas", "EuRoC csv": "line 2.*commas", "header without #": "line 1.*heading",
                       "duplicate line": "stamp 11", "zero quaternion": "line 1.*zeros",
                       "Fortran exponent": "line 2.*exponent"}.items():
        check.says("poses.txt: ", word, "exit 2", where=tries[name], name=name)


def poses_epoch_stamps(check):
    check.that(len(re.findall("poses.txt: .*since 1970.*subtract the first", check.output)) == 2, "not both told")
    check.silent("board", "written")


def poses_integer_seconds(check):
    check.says("120 read, 4 posed")
    check.that(psnrs(check.output)[-1] > 21, "poses of other frames")


def video_bt709(check):
    found = [float(value) for value in re.findall(r"mean (-?\d+\.\d+) mean abs", check.output)]
    check.that(len(found) == 9 and all(abs(value) <= 2 for value in found), f"{found} steps")


def video_trimmed_edit_list(check):
    check.says("frames +45\n", "45 read, 45 posed", "written")
    check.silent("damaged")


def video_vfr_fps(check):
    own, stated = parts(check.output)["fps none"], parts(check.output)["fps 30"]
    check.says("120 read, 120 posed", where=own)
    check.that(psnrs(own)[-1] > 22, "worse than with tags")
    check.says("note: .*fps", where=stated)


def main(program, sample, cases, name):
    source = pathlib.Path(cases) / name
    if not source.is_dir():
        print(f"{source} is not there")
        return SKIPPED
    script = (source / "run.sh").read_text()
    python_needs = re.findall(r"^ *(?:import|from) .*\b(cv2|numpy|PIL)\b", script, re.M)
    missing = [tool for tool in ("ffmpeg",) if "FFMPEG" in script and shutil.which(tool) is None]
    missing += [module for module in set(python_needs)
                if subprocess.run(["/usr/bin/python3", "-c", f"import {module}"], check=False,
                                  stderr=subprocess.DEVNULL).returncode]
    if missing:
        print("needs", *missing)
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "cases"
        shutil.copytree(cases, copy, ignore=shutil.ignore_patterns("work"))
        subprocess.run(["chmod", "-R", "u+w", copy], check=True)
        environment = dict(os.environ, SHEEN=os.path.realpath(program), SAMPLE=os.path.realpath(sample))
        ran = subprocess.run(["bash", copy / name / "run.sh"], env=environment, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    check = Check(ran.stdout)
    globals()[name.replace("-", "_")](check)
    print(ran.stdout)
    print("expected:", (source / "expected.txt").read_text())
    for fault in check.faults:
        print("FAULT:", fault)
    return 1 if check.faults else 0


sys.exit(main(*sys.argv[1:]))
