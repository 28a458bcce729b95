#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The web viewer in a real browser: it shows what the native renderer shows, and does what it is told.

Usage: viewer_test.py SHEEN REPOSITORY [FOLDER]. FOLDER, if given, keeps models, pages and pictures.
Exit code 77 where Chromium or a Python module is missing.
"""
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77
chromium = shutil.which("chromium")
if not chromium:
    print("skipped: Chromium is not installed (scripts/packages-test.txt)")
    sys.exit(SKIPPED)
try:
    import numpy as np
    from PIL import Image
    from chromium import Chromium
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

MODELS = {"sparse": ["--representation", "sparse"], "iwls": ["--representation", "iwls"],
          "detail": ["--offsets", "vertex"], "anchors": ["--offsets", "anchors"]}
SIZES = {"phone": (300, 520), "desktop": (560, 400)}
AZIMUTH, ELEVATION = -1.0, 0.5
HALF_HEIGHT, FILL = 0.3153, 0.86  # web/viewer/camera.js
DRAWN = "performance.getEntriesByName('first-picture').length > 0"


def run(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: {done.stderr}"
    return done.stdout


def positions_of(model):
    """Vertices of a model file, N x 3 metres."""
    data = model.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    accessor = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    view = document["bufferViews"][accessor["bufferView"]]
    start = 28 + length + view["byteOffset"]
    return np.frombuffer(data[start:start + 12 * accessor["count"]], dtype="<f4").reshape(-1, 3).astype(float)


def quaternion(rotation):
    """x, y, z, w of a rotation whose trace exceeds -1."""
    w = math.sqrt(max(0.0, 1 + np.trace(rotation))) / 2
    x, y, z = (rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1])
    return [x / (4 * w), y / (4 * w), z / (4 * w), w]


def write_grey_png(path, width, height):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    rows = (b"\0" + b"\x80" * 3 * width) * height
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_session(folder, mesh, positions, size):
    """A session of one view: the camera that the page begins with."""
    width, height = size
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2
    radius = np.linalg.norm(positions - centre, axis=1).max()
    distance = radius / (FILL * math.sin(math.atan(HALF_HEIGHT * min(1, width / height))))
    back = np.array([math.cos(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION)])
    right = np.cross([0, 0, 1], back) / np.linalg.norm(np.cross([0, 0, 1], back))
    stage_from_camera = np.stack([right, np.cross(-back, right), -back], axis=1)  # x right, y down, z forward
    eye = centre + distance * back
    folder.mkdir()
    (folder / "images").mkdir()
    write_grey_png(folder / "images" / "0000.png", width, height)
    shutil.copy(mesh, folder / "object.ply")
    numbers = [*eye, *quaternion(stage_from_camera)]
    (folder / "poses.txt").write_text("# stage_from_camera\n0 " + " ".join(f"{x:.12g}" for x in numbers) + "\n")
    focal = 0.5 * height / HALF_HEIGHT
    (folder / "camera.yaml").write_text(f"""%YAML:1.0
---
image_width: {width}
image_height: {height}
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ {focal}, 0., {0.5 * (width - 1)}, 0., {focal}, {0.5 * (height - 1)}, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
""")
    (folder / "session.json").write_text(json.dumps({
        "format": "sheen-session", "version": 1, "frames": {"images": "images/%04d.png"}, "camera": "camera.yaml",
        "poses": "poses.txt",
        "object": {"mesh": "object.ply", "T_stage_object": [float(i % 5 == 0) for i in range(16)]}}))


def check_same_picture(browser, sheen, folder, name, model, mesh):
    """Mean difference over the object's pixels below 2 of 255, from the view that the page begins with."""
    positions = positions_of(model)
    for label, size in SIZES.items():
        session = folder / f"{name}-{label}"
        write_session(session, mesh, positions, size)
        run(sheen, "render", model, "--views", session, "-o", session / "native", "--quiet")
        native = np.asarray(Image.open(session / "native" / "0000.png").convert("RGB")).astype(int)
        browser.resize(*size)
        browser.open((folder / f"{name}.html").as_uri() + f"#bare&background=black&fading=no&azimuth={AZIMUTH}&elevation={ELEVATION}", DRAWN)
        shown = browser.screenshot(session / "page.png")
        assert shown.shape == native.shape, (shown.shape, native.shape)
        difference = np.abs(shown - native)
        seen = native.max(axis=2) > 0
        mean = difference[seen].mean()
        # Inside the outline, which the page smooths.
        inside = seen.copy()
        for axis in (0, 1):
            for step in (-2, -1, 1, 2):
                inside &= np.roll(seen, step, axis)
        print(f"{name:7} {label:8} {seen.sum()} pixels: mean difference {mean:.3f} of 255, inside the outline "
              f"{difference[inside].mean():.3f}, 99.9 % below {np.quantile(difference[inside], .999):.0f}, worst {difference[inside].max()}")
        assert seen.mean() > 0.05, "the object is not in the picture"
        assert mean < 2, "the page does not show what the renderer shows"


def check_controls(browser, page):
    """Keys, fingers, wheel and buttons change the picture, and Reset brings it back."""
    width, height = SIZES["phone"]
    browser.resize(width, height, touch=True)
    browser.open(page.as_uri(), DRAWN)
    started = browser.value("performance.getEntriesByName('first-picture')[0].startTime")
    print(f"first picture after {started:.0f} ms")
    first = browser.screenshot()

    def changes(what, act):
        before = browser.screenshot()
        act()
        assert (browser.screenshot() != before).mean() > 0.01, f"{what} changes nothing"

    def drag(*ways):
        steps = 4
        for i in range(steps + 1):
            points = [(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps) for (x0, y0), (x1, y1) in ways]
            browser.touch("touchStart" if i == 0 else "touchMove", *points)
        browser.touch("touchEnd")

    changes("an arrow key", lambda: browser.key("ArrowRight"))
    changes("+", lambda: browser.key("+"))
    changes("a finger", lambda: drag([(150, 260), (210, 280)]))
    changes("a pinch", lambda: drag([(130, 260), (90, 260)], [(170, 260), (210, 260)]))
    changes("the wheel", lambda: browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=150, y=260, deltaX=0, deltaY=200))
    changes("b", lambda: browser.key("b"))
    browser.key("r")
    for _ in range(8):  # once through the backgrounds
        if browser.value("document.documentElement.style.getPropertyValue('--ground')").startswith("radial-gradient(circle at 50% 42%, #2b"):
            break
        browser.key("b")
        browser.next_picture()
    assert np.abs(browser.screenshot() - first).max() <= 1, "R does not bring the first view back"
    changes("Compare", lambda: browser.value("document.getElementById('compare').click()"))
    changes("Confidence", lambda: browser.value("document.getElementById('confidence').click()"))
    changes("the turntable", lambda: (browser.value("document.getElementById('turn').click()"), [browser.next_picture() for _ in range(10)]))
    assert not browser.value("document.getElementById('legend').hidden")


def check_told_where_nobody_looked(browser, page):
    """From below, where the recording never was, the reader is told; from where it was, not."""
    browser.resize(*SIZES["desktop"])
    for elevation, expected in [(-1.2, True), (0.6, False)]:
        browser.open(page.as_uri() + f"#elevation={elevation}", DRAWN)
        assert browser.value("!document.getElementById('told').hidden") == expected, elevation


def check_without_webgl(browser, page):
    """A browser without WebGL 2 is told so in a sentence."""
    script = browser.call("Page.addScriptToEvaluateOnNewDocument", source="HTMLCanvasElement.prototype.getContext = () => null")
    browser.open(page.as_uri(), "document.getElementById('fault')?.hidden === false")
    assert "WebGL\u00a02" in browser.value("document.getElementById('fault').textContent")
    browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])


def check(sheen, repository, folder):
    recording = repository / "sample_data" / "glossy"
    for name, options in MODELS.items():
        run(sheen, "replay", recording, "-o", folder / f"{name}.glb", *options, "--quiet")
        print(run(sheen, "export", folder / f"{name}.glb", "-o", folder / f"{name}.html", "--title", 'A <knot> & "more"').strip())
    with Chromium(chromium, folder / "profile") as browser:
        for name in MODELS:
            check_same_picture(browser, sheen, folder, name, folder / f"{name}.glb", recording / "object.ply")
        check_controls(browser, folder / "sparse.html")
        check_told_where_nobody_looked(browser, folder / "detail.html")
        assert browser.value("document.title") == 'A <knot> & "more"'
        check_without_webgl(browser, folder / "sparse.html")
        assert not browser.complaints, browser.complaints


sheen_program, repository_folder = sys.argv[1], pathlib.Path(sys.argv[2])
if len(sys.argv) > 3:
    kept = pathlib.Path(sys.argv[3])
    kept.mkdir(parents=True)
    check(sheen_program, repository_folder, kept.resolve())
else:
    with tempfile.TemporaryDirectory() as temporary:
        check(sheen_program, repository_folder, pathlib.Path(temporary))
