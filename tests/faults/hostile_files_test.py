# SPDX-License-Identifier: MIT
"""Files that claim more than they hold: refused in one line, within twice the memory of the honest file.

The program's own memory (that of `sheen --version`) is taken off both.
usage: hostile_files_test.py SHEEN SESSION FOLDER, a session with an AVI recording and a folder to work in
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

import numpy as np

SHEEN, SESSION, FOLDER = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1))
# What allocators and page sizes round by, in KB.
SLACK_KB = 8 * 1024
HUGE = 2**31 - 1


# Waits from a small process: a child's peak begins with what the process that forked it had.
WAIT = """import os, sys
pid = os.spawnv(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_maxrss)"""


def run(*args):
    """Exit code, lines of the error stream and peak memory in KB of `sheen ARGS`."""
    done = subprocess.run([sys.executable, "-S", "-c", WAIT, SHEEN, *map(str, args), "--quiet"], capture_output=True,
                          text=True, check=True)
    code, peak = done.stdout.split()[-2:]
    return int(code), done.stderr.splitlines(), int(peak)


def sphere(rows, columns):
    """Vertices [N][3] in metres and triangles [M][3] of a sphere without its poles' caps."""
    tilt, turn = np.meshgrid(np.linspace(0.1, 3.0, rows), np.arange(columns) * 2 * np.pi / columns, indexing="ij")
    points = 0.05 * np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), 1.5 + np.cos(tilt)], -1)
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    quads = np.stack([a, a + columns, b + columns, a, b + columns, b], -1)
    return points.reshape(-1, 3), quads.reshape(-1, 3)


def ply(points, triangles):
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    faces = np.zeros(len(triangles), dtype=[("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    return head.encode() + points.astype("<f4").tobytes() + faces.tobytes()


def obj(points, triangles):
    lines = ["v %.6f %.6f %.6f" % tuple(p) for p in points] + ["f %d %d %d" % tuple(t) for t in triangles + 1]
    return "\n".join(lines).encode() + b"\n"


def glb(points, triangles, change=lambda document: None):
    parts = [points.astype("<f4").tobytes(), triangles.astype("<u4").tobytes()]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": points.min(0).tolist(), "max": points.max(0).tolist()},
                      {"bufferView": 1, "componentType": 5125, "count": triangles.size, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(parts[0])},
                        {"buffer": 0, "byteOffset": len(parts[0]), "byteLength": len(parts[1])}],
        "buffers": [{"byteLength": sum(map(len, parts))}]}
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(parts)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(body), 0x004E4942) + body)


def png(width, height, lines):
    """A grey picture of `lines` lines that says it has `height`."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(b"\0" * (1 + 3 * width) * lines)) + chunk(b"IEND", b""))


def transforms(width=640, height=360, frames=3, name="images/{}.png"):
    """Cameras on a circle of 0.5 m that look at the origin, in nerfstudio's form."""
    poses = []
    for i in range(frames):
        turn = 2 * np.pi * i / frames
        back = np.array([np.cos(turn), np.sin(turn), 0.4])
        back /= np.linalg.norm(back)
        right = np.cross([0, 0, 1], back)
        right /= np.linalg.norm(right)
        pose = np.eye(4)
        pose[:3, :3] = np.stack([right, np.cross(back, right), back], 1)
        pose[:3, 3] = 0.5 * back
        poses.append({"file_path": name.format(i % 3), "transform_matrix": pose.tolist()})
    return {"w": width, "h": height, "fl_x": 600.0, "fl_y": 600.0, "cx": 320.0, "cy": 180.0, "frames": poses}


def colmap(folder, cameras=1, images=3, points=0, parameters=(600.0, 320.0, 180.0)):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cameras.bin").write_bytes(struct.pack("<QiiQQ3d", cameras, 1, 0, 640, 360, *parameters))
    records = b""
    for i in range(3):
        records += struct.pack("<i4d3di", i + 1, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1) + f"{i}.png".encode() + b"\0"
        records += struct.pack("<Q", points)
    (folder / "images.bin").write_bytes(struct.pack("<Q", images) + records)


class HostileFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.own = run("--version")[2]
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        cls.points, cls.triangles = sphere(400, 500)
        small = sphere(20, 30)
        (FOLDER / "small.ply").write_bytes(ply(*small))
        cls.dataset = FOLDER / "dataset"
        (cls.dataset / "images").mkdir(parents=True, exist_ok=True)
        for i in range(3):
            (cls.dataset / f"images/{i}.png").write_bytes(png(640, 360, 360))
        (cls.dataset / "transforms.json").write_text(json.dumps(transforms()))

    def need(self, *args):
        """Memory in KB beyond the program's own of a file that is taken."""
        code, errors, peak = run(*args)
        self.assertEqual(code, 0, errors)
        return peak - self.own

    def refused(self, need, what, *args):
        shutil.rmtree(FOLDER / "none", ignore_errors=True)
        code, errors, peak = run(*args)
        print(f"{what:44} {(peak - self.own) / 1024:7.1f} MB of {need / 1024:.1f}: {errors[0][:150] if errors else ''}")
        with self.subTest(what):
            self.assertEqual(code, 2, errors)
            self.assertEqual(len(errors), 1, errors)
            self.assertLess(peak - self.own, 2 * need + SLACK_KB)

    def mesh(self, what, need, suffix, data):
        path = FOLDER / f"hostile.{suffix}"
        path.write_bytes(data)
        self.refused(need, f"{suffix}: {what}", "import", self.dataset, "--mesh", path, "-o", FOLDER / "none")

    def honest_mesh(self, suffix, data):
        path = FOLDER / f"honest.{suffix}"
        path.write_bytes(data)
        return self.need("import", self.dataset, "--mesh", path, "-o", FOLDER / f"session-{suffix}")

    def test_ply(self):
        honest = ply(self.points, self.triangles)
        need = self.honest_mesh("ply", honest)
        count = str(len(self.points)).encode()
        faces = str(len(self.triangles)).encode()
        vertex = honest.index(b"end_header\n") + 11
        self.mesh("half of it", need, "ply", honest[:len(honest) // 2])
        for claim in (b"2147483647", b"99999999999999999999", b"-5"):
            self.mesh(f"{claim.decode()} vertices", need, "ply", honest.replace(b"vertex " + count, b"vertex " + claim, 1))
            self.mesh(f"{claim.decode()} faces", need, "ply", honest.replace(b"face " + faces, b"face " + claim, 1))
        self.mesh("a vertex that is no number", need, "ply",
                  honest[:vertex] + struct.pack("<f", np.nan) + honest[vertex + 4:])
        last = len(honest) - 4
        self.mesh("a face of vertex -1", need, "ply", honest[:last] + struct.pack("<i", -1) + honest[last:][4:])

    def test_obj(self):
        honest = obj(self.points, self.triangles)
        need = self.honest_mesh("obj", honest)
        for face in (b"f 1 2 2147483647\n", b"f -1 -2 -2147483648\n", b"f 1 2 99999999999999999999\n"):
            self.mesh(face.decode().strip(), need, "obj", honest + face)
        self.mesh("a vertex that is no number", need, "obj", b"v nan 0 0\n" + honest)

    def test_glb(self):
        honest = glb(self.points, self.triangles)
        need = self.honest_mesh("glb", honest)
        self.mesh("half of it", need, "glb", honest[:len(honest) // 2])
        self.mesh("chunk of 2 GB", need, "glb", honest[:12] + struct.pack("<I", HUGE) + honest[16:])

        def changed(what, path, value):
            def change(document):
                *way, last = path
                for step in way:
                    document = document[step]
                document[last] = value
            self.mesh(what, need, "glb", glb(self.points, self.triangles, change))
        changed("2 G positions", ("accessors", 0, "count"), HUGE)
        changed("2 G indices", ("accessors", 1, "count"), HUGE)
        changed("-1 positions", ("accessors", 0, "count"), -1)
        changed("view of 2^40 bytes", ("bufferViews", 0, "byteLength"), 2**40)
        changed("view that begins at -4", ("bufferViews", 1, "byteOffset"), -4)
        changed("positions in view 7", ("accessors", 0, "bufferView"), 7)

    def test_transforms(self):
        path = self.dataset / "transforms.json"
        honest = transforms(frames=30)
        path.write_text(json.dumps(honest))
        args = ("import", path, "--mesh", FOLDER / "small.ply", "-o")
        need = self.need(*args, FOLDER / "session-transforms")
        hostile = FOLDER / "dataset/hostile.json"
        args = ("import", hostile, "--mesh", FOLDER / "small.ply", "-o", FOLDER / "none")

        def text(what, content):
            hostile.write_text(content)
            self.refused(need, f"transforms: {what}", *args)
        text("half of it", json.dumps(honest)[:2000])
        text("a million brackets", '{"frames":' + "[" * 1000000)
        text("pictures of 2 G pixels a side", json.dumps(transforms(width=HUGE, height=HUGE)))
        text("outside its folder", json.dumps(transforms(name="../../../../etc/passwd")))
        text("absolute", json.dumps(transforms(name="/etc/passwd")))
        text("pose that is no number", json.dumps(honest).replace("0.5", "NaN", 1))

    def test_pictures(self):
        """Of another size than the camera says: told by their first bytes, before memory is taken for 2.7 GB."""
        session = FOLDER / "session-pictures"
        self.need("import", self.dataset, "--mesh", FOLDER / "small.ply", "-o", session)
        (session / "images/000000.png").write_bytes(png(30000, 30000, 2))
        self.refused(self.own, "picture of 900 million pixels in 3 KB", "replay", session, "-o", FOLDER / "none.glb")

    def test_session(self):
        def session(name="", data=b""):
            """A copy in which one file is another."""
            folder = FOLDER / "session"
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(SESSION, folder, ignore=shutil.ignore_patterns("held_out"))
            if name:
                (folder / name).write_bytes(data)
            return folder
        model = FOLDER / "model.glb"
        replay = ("-o", model, "--representation", "mean", "--end", 5)
        need = self.need("replay", session(), *replay)
        told = self.need("info", session())

        def altered(what, name, data):
            self.refused(told, f"{name}: {what}", "info", session(name, data))
        document = json.loads((SESSION / "session.json").read_text())
        altered("a million brackets", "session.json", b"[" * 1000000)
        altered("a list of a million numbers", "session.json", json.dumps([0] * 1000000).encode())
        altered("half of it", "session.json", json.dumps(document).encode()[:100])
        for name in ("board.yaml", "camera.yaml"):
            honest = (SESSION / name).read_bytes()
            altered("half of it", name, honest[:len(honest) // 2])
            altered("a million brackets", name, b"%YAML:1.0\na: " + b"[" * 1000000)
            altered("a line of 1 MB", name, b"%YAML:1.0\n" + b"a" * 2**20)
        altered("image of 2 G pixels a side", "camera.yaml",
                (SESSION / "camera.yaml").read_bytes().replace(b"640", b"2147483647", 1))

        # A recording that ends early is taken up to there, one that only claims more as far as it goes.
        video = bytearray((SESSION / "frames.avi").read_bytes())
        first = video.index(b"00dc", video.index(b"movi"))
        for what, at in (("a picture of 2 GB", first + 4), ("a list of 2 GB", 4), ("2 G pixels a line", video.index(b"strf") + 12)):
            hostile = video.copy()
            hostile[at:at + 4] = struct.pack("<I", HUGE)
            code, errors, peak = run("replay", session("frames.avi", hostile), "-o", FOLDER / "taken.glb", *replay[2:])
            (FOLDER / "taken.glb").unlink(missing_ok=True)
            print(f"frames.avi: {what:32} {(peak - self.own) / 1024:7.1f} MB of {need / 1024:.1f}: {code} {errors[:1]}")
            with self.subTest(what):
                self.assertIn(code, (0, 2), errors)
                self.assertLess(peak - self.own, 2 * need + SLACK_KB)

        honest = model.read_bytes()
        need = self.need("info", model)
        for what, data in (("half of it", honest[:len(honest) // 2]),
                           ("chunk of 2 GB", honest[:12] + struct.pack("<I", HUGE) + honest[16:]),
                           ("a number altered", honest.replace(b'"count":9', b'"count":8', 1))):
            model.write_bytes(data)
            self.refused(need, f"model: {what}", "info", model)

    def test_state(self):
        state = FOLDER / "fit.state"
        code, errors, _ = run("replay", SESSION, "-o", FOLDER / "state.glb", "--state", state, "--representation", "mean", "--end", 5)
        self.assertEqual(code, 0, errors)
        honest = state.read_bytes()
        need = self.need("info", state)
        self.assertGreater(len(honest), 64)
        for what, data in (("half of it", honest[:len(honest) // 2]), ("its head alone", honest[:32]),
                           ("bytes of ones", honest[:32] + b"\xff" * (len(honest) - 32))):
            state.write_bytes(data)
            self.refused(need, f"state: {what}", "info", state)

    def test_colmap(self):
        model = FOLDER / "colmap/sparse/0"
        colmap(model)
        images = FOLDER / "colmap/images"
        images.mkdir(parents=True, exist_ok=True)
        for i in range(3):
            (images / f"{i}.png").write_bytes(png(640, 360, 360))
        args = ("import", FOLDER / "colmap", "--mesh", FOLDER / "small.ply", "-o")
        need = self.need(*args, FOLDER / "session-colmap")
        for claim in (HUGE, 2**60, 2**64 - 1):
            for kind in ("cameras", "images", "points"):
                colmap(model, **{kind: claim})
                self.refused(need, f"colmap: {claim} {kind}", *args, FOLDER / "none")
        colmap(model, parameters=(np.nan, 320.0, 180.0))
        self.refused(need, "colmap: focal length that is no number", *args, FOLDER / "none")
        colmap(model)
        whole = (model / "images.bin").read_bytes()
        (model / "images.bin").write_bytes(whole[:len(whole) // 2])
        self.refused(need, "colmap: half of images.bin", *args, FOLDER / "none")


if __name__ == "__main__":
    unittest.main()
