#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Exported meshes and splats, opened by programs of others and compared with each other.

numpy reads the bytes as the formats' documents say; three.js' loaders and Khronos' glTF validator
open the same files where `npm ci --prefix tests/exporters/foreign` has been run, assimp where it is
installed. The three splat files must say the same in their three ways.

Usage: foreign_test.py SHEEN REPOSITORY [FOLDER]. FOLDER, if given, keeps the files.
Exit code 77 where numpy is missing.
"""
import gzip
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

FRAMES = 40
FILES = ["mesh.ply", "mesh.obj", "mesh.usda", "mesh.glb", "splats.splat.ply", "splats.spz", "splats.glb"]


def run(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: {done.stderr[-3000:]}"
    return done.stdout


def rotations(w, x, y, z):
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                     2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=-1).reshape(-1, 3, 3)


def covariances(splats):
    """Of the Gaussians: 3 x 3 each."""
    turn = rotations(*splats["rotation"].T)
    return np.einsum("nij,nj,nkj->nik", turn, splats["sigma"] ** 2, turn)


def colours(harmonics, d):
    """Kerbl et al.'s sh_utils.py: `harmonics` [n][16][3], `d` from camera to splat."""
    x, y, z = d
    xx, yy, zz, xy, yz, xz = x * x, y * y, z * z, x * y, y * z, x * z
    c1, c2 = 0.4886025119029199, 1.0925484305920792
    basis = [0.28209479177387814, -c1 * y, c1 * z, -c1 * x,
             c2 * xy, -c2 * yz, 0.31539156525252005 * (2 * zz - xx - yy), -c2 * xz, c2 / 2 * (xx - yy),
             -0.5900435899266435 * y * (3 * xx - yy), 2.890611442640554 * xy * z,
             -0.4570457994644658 * y * (4 * zz - xx - yy), 0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
             -0.4570457994644658 * x * (4 * zz - xx - yy), 1.445305721320277 * z * (xx - yy),
             -0.5900435899266435 * x * (xx - 3 * yy)]
    return np.maximum(0, 0.5 + np.einsum("k,nkc->nc", basis, harmonics))


def read_splat_ply(path):
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    count = int(lines[2].removeprefix("element vertex "))
    names = ["x", "y", "z", "nx", "ny", "nz"] + [f"f_dc_{i}" for i in range(3)] \
        + [f"f_rest_{i}" for i in range(45)] + ["opacity"] + [f"scale_{i}" for i in range(3)] \
        + [f"rot_{i}" for i in range(4)]
    assert lines[3:] == [f"property float {name}" for name in names], "not the reference's order"
    values = np.frombuffer(body, "<f4").reshape(count, 62).astype(float)
    rest = values[:, 9:54].reshape(count, 3, 15).transpose(0, 2, 1)
    return {"position": values[:, :3], "harmonics": np.concatenate([values[:, None, 6:9], rest], axis=1),
            "opacity": 1 / (1 + np.exp(-values[:, 54])), "sigma": np.exp(values[:, 55:58]),
            "rotation": values[:, 58:62]}


def read_spz(path):
    data = gzip.decompress(path.read_bytes())
    magic, version, count, degree, bits, flags, reserved = struct.unpack("<IIIBBBB", data[:16])
    assert (magic, version, degree, flags, reserved) == (0x5053474E, 2, 3, 0, 0)
    parts = np.split(np.frombuffer(data[16:], np.uint8), np.cumsum([9 * count, count, 3 * count, 3 * count, 3 * count]))
    position, opacity, colour, sigma, rotation, rest = parts
    assert rest.size == 45 * count
    triples = position.reshape(count, 3, 3).astype(int) @ [1, 256, 65536]
    triples -= (triples >= 1 << 23) * (1 << 24)
    vector = rotation.reshape(count, 3) / 127.5 - 1
    w = np.sqrt(np.maximum(0, 1 - (vector**2).sum(1)))
    return {"position": triples / 2.0**bits, "opacity": opacity / 255,
            "harmonics": np.concatenate([(colour.reshape(count, 1, 3) / 255 - 0.5) / 0.15,
                                         (rest.reshape(count, 15, 3) - 128.0) / 128], axis=1),
            "sigma": np.exp(sigma.reshape(count, 3) / 16 - 10), "rotation": np.column_stack([w, vector])}


def read_glb(path):
    data = path.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20:20 + length]), data[28 + length:]

    def numbers(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]]
        return np.frombuffer(binary, kind, accessor["count"] * width, view["byteOffset"]).reshape(-1, width)

    return document, numbers


def read_splat_glb(path):
    document, numbers = read_glb(path)
    primitive = document["meshes"][0]["primitives"][0]
    extension = primitive["extensions"]["KHR_gaussian_splatting"]
    assert primitive["mode"] == 0 and document["extensionsUsed"] == ["KHR_gaussian_splatting"]
    assert extension["kernel"] == "ellipse" and extension["colorSpace"] == "srgb_rec709_display"
    names = primitive["attributes"]
    get = lambda name: numbers(names["KHR_gaussian_splatting:" + name]).astype(float)
    harmonics = [get(f"SH_DEGREE_{l}_COEF_{n}") for l in range(4) for n in range(2 * l + 1)]
    return {"position": numbers(names["POSITION"]).astype(float), "opacity": get("OPACITY")[:, 0], "sigma": get("SCALE"),
            "rotation": np.roll(get("ROTATION"), 1, axis=1), "harmonics": np.stack(harmonics, axis=1)}


def check_splats(folder):
    ply, spz, glb = (read(folder / name) for read, name in
                     ((read_splat_ply, FILES[4]), (read_spz, FILES[5]), (read_splat_glb, FILES[6])))
    flip = np.array([1.0, -1.0, -1.0])  # y down against y up
    assert np.allclose(ply["position"] * flip, glb["position"], atol=1e-7)
    assert np.allclose(ply["sigma"], glb["sigma"], rtol=1e-5) and np.allclose(ply["opacity"], 0.95, atol=1e-6)
    scale = (glb["sigma"] ** 2).max(axis=(1,))[:, None, None]
    turned = flip[:, None] * covariances(ply) * flip
    assert np.abs((turned - covariances(glb)) / scale).max() < 1e-4
    # Discs: as thin as said along one axis, which is the vertex's normal.
    assert np.allclose(glb["sigma"][:, 2], 0.05 * glb["sigma"][:, :2].mean(1), rtol=1e-5)
    # What is rounded to bytes.
    assert np.abs(spz["position"] - glb["position"]).max() < 1e-6
    assert np.abs(np.log(spz["sigma"] / glb["sigma"])).max() < 0.51 / 16
    # 1 / 127.5 of a quaternion is up to twice that of an angle, where w is small more.
    difference = np.abs((covariances(spz) - covariances(glb)) / scale)
    assert np.quantile(difference, 0.99) < 0.1, np.quantile(difference, 0.99)
    random = np.random.default_rng(5)
    for _ in range(20):
        d = random.normal(size=3)
        d /= np.linalg.norm(d)
        true = colours(glb["harmonics"], d)
        assert np.abs(colours(ply["harmonics"], d * flip) - true).max() < 1e-4
        # 15 terms, each off by up to 1/256 (more where it is beyond +-1) in a basis whose squares sum to 16 / 4 pi.
        assert np.sqrt(np.mean((colours(spz["harmonics"], d) - true) ** 2)) < 0.01
    print(f"  {len(glb['position'])} splats say the same in PLY, SPZ and glTF")
    return glb


def splat_picture(splats, camera_from_splats, focal, centre, size):
    """Kerbl et al.'s rasteriser: nearest last in sorting, first in mixing; 0.3 px^2 more, opacity at most 0.99."""
    turn, shift = camera_from_splats[:, :3], camera_from_splats[:, 3]
    eye = -turn.T @ shift
    p = splats["position"] @ turn.T + shift
    towards = splats["position"] - eye
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    shown = np.array([colours(h[None], d)[0] for h, d in zip(splats["harmonics"], towards)])
    x, y, z = p.T
    jacobian = np.zeros((len(p), 2, 3))
    jacobian[:, 0, 0], jacobian[:, 0, 2] = focal[0] / z, -focal[0] * x / z**2
    jacobian[:, 1, 1], jacobian[:, 1, 2] = focal[1] / z, -focal[1] * y / z**2
    to_pixels = jacobian @ turn
    spread = to_pixels @ covariances(splats) @ to_pixels.transpose(0, 2, 1) + 0.3 * np.eye(2)
    inverse = np.linalg.inv(spread)
    middle = np.column_stack([x / z, y / z]) * focal + centre - 0.5  # counted from the first pixel's centre
    reach = np.ceil(3 * np.sqrt(np.linalg.eigvalsh(spread)[:, 1])).astype(int)
    picture, through = np.zeros((size[1], size[0], 3)), np.ones((size[1], size[0]))
    for i in np.argsort(z):
        (left, top), r = np.round(middle[i]).astype(int), reach[i]
        columns = np.arange(max(0, left - r), min(size[0], left + r + 1))
        rows = np.arange(max(0, top - r), min(size[1], top + r + 1))
        if not len(columns) or not len(rows):
            continue
        dx, dy = columns - middle[i, 0], (rows - middle[i, 1])[:, None]
        a = inverse[i]
        alpha = splats["opacity"][i] * np.exp(-0.5 * (a[0, 0] * dx**2 + 2 * a[0, 1] * dx * dy + a[1, 1] * dy**2))
        alpha = np.minimum(alpha, 0.99)
        alpha[alpha < 1 / 255] = 0
        part = np.s_[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]
        picture[part] += (through[part] * alpha)[:, :, None] * shown[i]
        through[part] *= 1 - alpha
    return picture


def eroded(mask):
    for _ in range(2):
        inner = mask.copy()
        inner[1:] &= mask[:-1]
        inner[:-1] &= mask[1:]
        inner[:, 1:] &= mask[:, :-1]
        inner[:, :-1] &= mask[:, 1:]
        mask = inner
    return mask


def check_splat_pictures(sheen, session, splats, folder):
    """Splats drawn by a rasteriser of splats against photographs: both exports at once."""
    try:
        from PIL import Image
    except ImportError:
        return
    run(sheen, "export", session, "-o", folder / "views", "--format", "nerfstudio", "--undistort", "--quiet")
    file = json.loads((folder / "views" / "transforms.json").read_text())
    place = json.loads((session / "session.json").read_text())["object"]["T_stage_object"]
    board_from_object = np.reshape(place, (4, 4))
    object_from_splats = np.eye(4)
    object_from_splats[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]  # (x, -z, y) back to (x, y, z)
    scores = []
    for frame in file["frames"][::4]:
        board_from_camera = np.array(frame["transform_matrix"]) @ np.diag([1.0, -1.0, -1.0, 1.0])
        pose = np.linalg.inv(board_from_camera) @ board_from_object @ object_from_splats
        picture = splat_picture(splats, pose[:3], np.array([file["fl_x"], file["fl_y"]]),
                                np.array([file["cx"], file["cy"]]), (file["w"], file["h"]))
        image = np.asarray(Image.open(folder / "views" / frame["file_path"])) / 255
        mask = eroded(np.asarray(Image.open(folder / "views" / frame["mask_path"])) > 0)
        scores.append(-10 * np.log10(np.mean((np.clip(picture, 0, 1) - image)[mask] ** 2)))
        Image.fromarray((255 * np.clip(np.hstack([picture, image * mask[:, :, None]]), 0, 1)).astype(np.uint8)).save(
            folder / f"splats-{len(scores)}.png")
    print(f"  drawn as splats: {np.mean(scores):.2f} dB on {len(scores)} views")
    assert np.mean(scores) > 22, scores


def check_foreign_pictures(session, splats, folder):
    """The same picture by viewers of others. Their discs end earlier than the reference's, which is seen at outlines."""
    import splat_viewers
    if missing := splat_viewers.missing():
        print(f"  not drawn by viewers of others, missing: {', '.join(missing)}")
        return
    file = json.loads((folder / "views" / "transforms.json").read_text())
    place = np.reshape(json.loads((session / "session.json").read_text())["object"]["T_stage_object"], (4, 4))
    board_from_camera = np.array(file["frames"][0]["transform_matrix"]) @ np.diag([1.0, -1.0, -1.0, 1.0])
    y_down = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])  # object from splats
    pose = np.linalg.inv(board_from_camera) @ place @ y_down
    y_up = pose @ np.diag([1.0, -1.0, -1.0, 1.0])
    size, focal, centre = (file["w"], file["h"]), np.array([file["fl_x"], file["fl_y"]]), np.array([file["cx"], file["cy"]])
    ours = 255 * np.clip(splat_picture(splats, pose[:3], focal, centre, size), 0, 1)
    shown = ours.max(axis=2) > 8
    distance = np.linalg.norm(pose[:3, 3])
    projection = splat_viewers.clip_from_camera(focal, centre, size, 0.1 * distance, 10 * distance)
    files = [folder / name for name in FILES[4:]]
    for viewer, name, picture in splat_viewers.draw(files, [pose[:3], y_up[:3], y_up[:3]], projection, size, folder / "viewers"):
        difference = np.abs(picture - ours)
        inside = difference[eroded(shown)]
        print(f"  {viewer:<6}{name:<17} mean difference {difference[shown].mean():.2f} of 255, inside the outline "
              f"{inside.mean():.2f}, 99 % of it below {np.quantile(inside, .99):.0f}")
        assert difference[shown].mean() < 6 and inside.mean() < 4, (viewer, name)


def foreign_facts(repository, files):
    foreign = repository / "tests" / "exporters" / "foreign"
    if not shutil.which("node") or not (foreign / "node_modules").exists():
        print("  not opened by three.js and Khronos' validator: npm ci --prefix tests/exporters/foreign")
        return None
    return json.loads(run("node", foreign / "open.mjs", *files))


def check_foreign_splats(facts, splats):
    for name in FILES[4:]:
        attributes = facts[name]["attributes"]
        values = {key: np.array(a["values"]).reshape(-1, a["size"]) for key, a in attributes.items()}
        assert all(a["count"] == len(splats["position"]) for a in attributes.values()), name
        flip = np.array([1.0, -1.0, -1.0]) if name.endswith(".splat.ply") else np.ones(3)
        shown = len(values["position"])
        assert np.allclose(values["position"] * flip, splats["position"][:shown], atol=1e-6), name
        # Upper triangles of the covariances; SPZ has rounded the widths by up to 3 %.
        turned = flip[:, None] * covariances(splats)[:shown] * flip
        upper = turned[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]
        scale = turned.max(axis=(1, 2))[:, None]
        assert np.abs((values["covariance"] - upper) / scale).max() < (0.15 if name.endswith(".spz") else 1e-3), name
        colour = np.column_stack([0.5 + 0.28209479177387814 * splats["harmonics"][:shown, 0], splats["opacity"][:shown]])
        # A byte of SPZ's colours is 1 / 0.15 / 255 of the coefficient, 1.9 levels.
        levels = 2.0 if name.endswith(".spz") else 1.01
        assert np.abs(values["color"] - 255 * colour).max() < levels, (name, np.abs(values["color"] - 255 * colour).max())
        assert {f"sphericalHarmonics{degree}" for degree in (1, 2, 3)} <= attributes.keys(), name
    print("  three.js opens the splats: places, covariances, colours")


def check_foreign_meshes(facts, triangles):
    lowest = [facts[name]["lowest"] for name in ("mesh.glb", "mesh.obj", "mesh.usda")]
    assert np.allclose(lowest, lowest[0], atol=1e-6)
    # PLY keeps the object's axes: (x, y, z) there is (x, z, -y) with y up.
    low, high = facts["mesh.ply"]["lowest"], facts["mesh.ply"]["highest"]
    assert np.allclose(lowest[0], [low[0], low[2], -high[1]], atol=1e-6)
    for name in FILES[:4]:
        assert facts[name]["triangles"] == triangles, (name, facts[name])
        assert facts[name]["normals"] == facts[name]["vertices"], name
    assert facts["mesh.glb"]["material"] == "MeshBasicMaterial" and facts["mesh.obj"]["material"] == "surface"
    assert facts["mesh.glb"]["places"] and facts["mesh.obj"]["places"]
    assert np.allclose(facts["mesh.ply"]["firstColour"], facts["mesh.usda"]["firstColour"], atol=0.01), facts
    print(f"  three.js opens the meshes: {triangles} triangles, texture {facts['mesh.glb']['texture']}")


def check_validator(facts):
    for name in ("mesh.glb", "splats.glb"):
        found = facts[name]["validator"]
        print(f"  glTF validator, {name}: {found['errors']} errors, {found['warnings']} warnings")
        # This version of the validator knows no attribute names with a colon, which the extension has.
        unknown = [m for m in found["messages"]
                   if m.startswith("MESH_PRIMITIVE_INVALID_ATTRIBUTE") and "/KHR_gaussian_splatting:" in m]
        assert found["errors"] == len(unknown), found


def check_assimp(folder):
    if not shutil.which("assimp"):
        return
    for name in ("mesh.obj", "mesh.ply", "mesh.glb"):
        said = run("assimp", "info", folder / name)
        assert "Meshes:             1" in said, said


def check_texture(folder, name):
    """The texture shows what the vertices' colours do, where vertices lie on it (at seams in several places)."""
    try:
        from PIL import Image
    except ImportError:
        return
    document, numbers = read_glb(folder / "mesh.glb")
    attributes = document["meshes"][0]["primitives"][0]["attributes"]
    places = numbers(attributes["TEXCOORD_0"]) / 65535
    image = np.asarray(Image.open(folder / "mesh.png")).astype(float)
    pixels = places * [image.shape[1], image.shape[0]] - 0.5
    pixels = np.clip(pixels, 0, [image.shape[1] - 1.001, image.shape[0] - 1.001])
    left, top = np.floor(pixels).astype(int).T
    right, down = (pixels - np.floor(pixels)).T[:, :, None]
    read = (1 - down) * ((1 - right) * image[top, left] + right * image[top, left + 1]) \
        + down * ((1 - right) * image[top + 1, left] + right * image[top + 1, left + 1])
    data = (folder / "mesh.ply").read_bytes().split(b"end_header\n", 1)
    count = int(data[0].split(b"element vertex ")[1].split()[0])
    vertex = np.frombuffer(data[1], np.dtype([("p", "<f4", 6), ("c", "u1", 3), ("confidence", "<f4"), ("seen", "<u2", 4)]), count)
    used = np.unique(numbers(document["meshes"][0]["primitives"][0]["indices"]))
    used = used[used < count]
    assert np.array_equal(numbers(attributes["_CONFIDENCE"])[:count, 0], vertex["confidence"])
    assert np.array_equal(numbers(attributes["_SEEN"])[:count], vertex["seen"]) and vertex["seen"].any()
    difference = np.abs(read[used] - vertex["c"][used])
    print(f"  {name}: texture at the vertices within {difference.mean():.2f} of 255 on average, worst {difference.max():.0f}")
    assert difference.mean() < 1.5 and np.quantile(difference, 0.99) < 30, difference.mean()


def check_model(sheen, repository, patches, folder):
    folder.mkdir()
    sample = repository / "sample_data" / "glossy"
    model = folder / "model.glb"
    run(sheen, "replay", sample, "-o", model, "--patches", patches, "--end", FRAMES, "--quiet")
    print(f"patches {patches}: {model.stat().st_size} bytes")
    for name in FILES:
        options = ["--splats"] if name == "splats.glb" else []
        report = json.loads(run(sheen, "export", model, "-o", folder / name, "--json", "--quiet",
                                "--views", sample / "held_out", *options))
        views = report["cost"]["on_views"]
        size = sum(file["bytes"] for file in report["files"])
        print(f"  {name:<17}{size:>9} bytes, {views['converted_db']:.2f} dB on views, the model {views['model_db']:.2f}")
    document, numbers = read_glb(folder / "mesh.glb")
    triangles = len(numbers(document["meshes"][0]["primitives"][0]["indices"])) // 3
    check_texture(folder, patches)
    splats = check_splats(folder)
    check_splat_pictures(sheen, sample / "held_out", read_splat_ply(folder / FILES[4]), folder)
    if patches == "vertex":
        check_foreign_pictures(sample / "held_out", read_splat_ply(folder / FILES[4]), folder)
    check_assimp(folder)
    facts = foreign_facts(repository, [folder / name for name in FILES])
    if facts:
        check_foreign_meshes(facts, triangles)
        check_validator(facts)
        check_foreign_splats(facts, splats)


def main():
    sheen, repository = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        folder.mkdir(exist_ok=True)
        for patches in ("vertex", "detail"):
            check_model(sheen, repository, patches, folder / patches)


main()
