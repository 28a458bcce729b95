# SPDX-License-Identifier: MIT
"""Draws files of splats with viewers that this project did not write, in a headless Chromium.

The viewers are npm packages (`npm ci --prefix tests/exporters/foreign`), bundled by esbuild.
"""
import functools
import http.server
import json
import pathlib
import shutil
import subprocess
import sys
import threading

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "web"))
FOREIGN = pathlib.Path(__file__).resolve().parent / "foreign"
VIEWERS = {"three": (".splat.ply", ".spz", ".glb"), "spark": (".splat.ply", ".spz")}


def missing():
    """What is not here of all that is needed; empty where nothing is."""
    tools = [tool for tool in ("chromium", "esbuild") if not shutil.which(tool)]
    return tools + ([] if (FOREIGN / "node_modules" / "@sparkjsdev").exists() else ["npm ci --prefix tests/exporters/foreign"])


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def clip_from_camera(focal, centre, size, near, far):
    """OpenGL's projection of a camera whose pixels are counted from the corner of the first one."""
    (w, h), (fx, fy), (cx, cy) = size, focal, centre
    return [2 * fx / w, 0, 1 - 2 * cx / w, 0, 0, 2 * fy / h, 2 * cy / h - 1, 0,
            0, 0, -(far + near) / (far - near), -2 * far * near / (far - near), 0, 0, -1, 0]


def draw(files, views, projection, size, folder):
    """Yields (viewer, file, picture of 0 to 255) of every file by every viewer that reads it.

    `views`: for each file the pose of a camera with y down and z forward, 3 x 4, camera from splats."""
    from chromium import Chromium
    folder.mkdir()
    for viewer in VIEWERS:
        subprocess.run(["esbuild", f"splats_by_{viewer}.js", "--bundle", "--format=esm", "--log-level=error",
                        f"--outfile={folder / viewer}.js"], cwd=FOREIGN, check=True)
        (folder / f"{viewer}.html").write_text(
            "<!doctype html><link rel=icon href=data:,><style>body { margin: 0; background: #000; } canvas { display: block; }</style>"
            f"<body><script type=module src={viewer}.js></script>")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with Chromium(shutil.which("chromium"), folder / "profile") as browser:
            browser.resize(*size)
            for file, pose in zip(files, views):
                shutil.copy(file, folder / file.name)
                camera_from_splats = np.vstack([np.diag([1.0, -1.0, -1.0]) @ pose, [0, 0, 0, 1]])
                (folder / "view.json").write_text(json.dumps({
                    "file": file.name, "width": size[0], "height": size[1], "clip_from_camera": projection,
                    "world_from_camera": np.linalg.inv(camera_from_splats).ravel().tolist()}))
                for viewer in (v for v, endings in VIEWERS.items() if file.name.endswith(endings)):
                    try:
                        browser.open(f"http://127.0.0.1:{server.server_port}/{viewer}.html", "window.isDrawn")
                    except RuntimeError as fault:
                        raise RuntimeError(f"{viewer}, {file.name}: {fault} {browser.complaints}")
                    yield viewer, file.name, browser.screenshot(folder / f"{viewer}-{file.name}.png")
    finally:
        server.shutdown()
