#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sessions as data sets, read by a script of its own and by COLMAP.

Where tags stand in the exported images, by transforms.json and COLMAP's text alone, is compared with
the poses that `sheen replay` writes and with the corners that OpenCV's detector finds (where
python3-opencv is installed); an import brings camera and poses back; COLMAP reads its model and
triangulates its own features from the exported poses.

Usage: dataset_test.py SHEEN REPOSITORY [FOLDER]. FOLDER, if given, keeps the data sets.
Exit code 77 where numpy is missing.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

FRAMES = 12


def run(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: {done.stderr[-2000:]}"
    return done.stdout + done.stderr


def rotation(w, x, y, z):
    w, x, y, z = np.array([w, x, y, z]) / np.linalg.norm([w, x, y, z])
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def tag_corners(board):
    """Tag -> its corners, clockwise."""
    corners = {}
    for entry in re.findall(r"\{(id:.*?)\}", board.read_text()):
        tag = {key: float(value) for key, value in (part.split(":") for part in entry.split(","))
               for key in [key.strip()]}
        half = tag["size"] / 2
        square = np.array([[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]])
        turn = rotation(tag["qw"], tag["qx"], tag["qy"], tag["qz"])
        corners[int(tag["id"])] = square @ turn.T + [tag["x"], tag["y"], tag["z"]]
    return corners


def distorted(p, k1, k2, p1, p2, k3=0.0, k4=0.0, k5=0.0, k6=0.0):
    """OpenCV's documentation, "rational model"."""
    x, y = p[:, 0], p[:, 1]
    r2 = x * x + y * y
    radial = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
    return np.stack([x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                     y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y], axis=1)


class Views:
    """Image name -> projection to places counted from the image's corner (pixel centre + 1/2)."""

    def __init__(self):
        self.focal, self.centre, self.distortion, self.poses = None, None, (), {}

    def places(self, image, points):
        turn, shift = self.poses[image]  # from world to a camera of x right, y down
        p = points @ turn.T + shift
        return distorted(p[:, :2] / p[:, 2:], *(self.distortion or (0, 0, 0, 0))) * self.focal + self.centre


def from_transforms(path):
    file = json.loads(path.read_text())
    views = Views()
    views.focal, views.centre = [file["fl_x"], file["fl_y"]], [file["cx"], file["cy"]]
    views.distortion = [file[k] for k in ("k1", "k2", "p1", "p2", "k3")]
    for frame in file["frames"]:
        pose = np.array(frame["transform_matrix"])
        turn = (pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])).T
        views.poses[pathlib.Path(frame["file_path"]).name] = turn, -turn @ pose[:3, 3]
    return views


def from_colmap_text(folder):
    views = Views()
    _, model, _, _, *numbers = [line for line in (folder / "cameras.txt").read_text().splitlines()
                                if not line.startswith("#")][0].split()
    assert model in ("PINHOLE", "OPENCV", "FULL_OPENCV"), model
    numbers = [float(n) for n in numbers]
    views.focal, views.centre, views.distortion = numbers[:2], numbers[2:4], numbers[4:]
    lines = [line for line in (folder / "images.txt").read_text().splitlines() if not line.startswith("#")]
    for line in lines[::2]:
        _, w, x, y, z, tx, ty, tz, _, name = line.split()
        views.poses[name] = (rotation(*map(float, (w, x, y, z))), np.array([tx, ty, tz], float))
    return views


def from_poses(poses, camera):
    """TUM lines and an OpenCV camera file, whose first pixel's centre is (0, 0)."""
    views = Views()
    text = camera.read_text()
    matrix, distortion = ([float(n) for n in data.split(",")] for data in
                          re.findall(r"data: \[(.*?)\]", text, re.DOTALL))
    views.focal, views.centre = [matrix[0], matrix[4]], [matrix[2] + 0.5, matrix[5] + 0.5]
    views.distortion = distortion
    for line in poses.read_text().splitlines():
        if line.startswith("#"):
            continue
        index, tx, ty, tz, x, y, z, w = map(float, line.split())
        turn = rotation(w, x, y, z).T
        views.poses[int(index)] = turn, -turn @ np.array([tx, ty, tz])
    return views


def frame_of(image):
    return int(pathlib.Path(image).stem)


def expect_places(views, poses, corners):
    """A thousandth of a pixel; poses.txt has nine digits."""
    assert sorted(map(frame_of, views.poses)) == sorted(poses.poses), "not the frames that were posed"
    worst = max(np.abs(views.places(image, square) - poses.places(frame_of(image), square)).max()
                for image in views.poses for square in corners.values())
    assert worst < 1e-3, worst
    return worst


def detected_differences(images, views, corners, dictionary):
    """Corners found in the images less those of the board by the data set's poses, pixels."""
    try:
        import cv2
    except ImportError:
        print("  not compared with detected corners: no python3-opencv")
        return None
    parameters = cv2.aruco.DetectorParameters_create()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    known = cv2.aruco.Dictionary_get(getattr(cv2.aruco, dictionary))
    differences = []
    for image in views.poses:
        grey = cv2.imread(str(images / image), cv2.IMREAD_GRAYSCALE)
        found, ids, _ = cv2.aruco.detectMarkers(grey, known, parameters=parameters)
        for square, tag in zip(found, [] if ids is None else ids.ravel()):
            if int(tag) in corners:
                places = views.places(image, corners[int(tag)])
                # Dictionaries do not agree on which corner is the first.
                differences.append(min((np.roll(square[0], turn, axis=0) + 0.5 - places for turn in range(4)),
                                       key=lambda difference: np.abs(difference).sum()))
    return np.concatenate(differences)


def expect_detected(name, images, views, corners, dictionary, worst_mean):
    found = detected_differences(images, views, corners, dictionary)
    if found is None:
        return
    mean, rms = np.median(found, axis=0), np.sqrt(np.median((found**2).sum(1)))
    print(f"  {name}: {len(found)} corners, median difference {mean[0]:+.3f} {mean[1]:+.3f} px, rms {rms:.3f} px")
    # Half a pixel the wrong way would be off by 1/2 or 1 in both.
    assert np.abs(mean).max() < worst_mean and rms < 1, (mean, rms)


def check_import(sheen, dataset, poses, camera, folder):
    run(sheen, "import", dataset, "--mesh", dataset / "object.ply", "-o", folder, "--quiet")
    back, true = from_poses(folder / "poses.txt", folder / "camera.yaml"), from_poses(poses, camera)
    assert np.allclose(back.focal + back.centre, true.focal + true.centre, atol=1e-6, rtol=0)
    used = max(len(back.distortion), len(true.distortion))
    padded = [np.pad(v.distortion, (0, used - len(v.distortion))) for v in (back, true)]
    assert np.allclose(*padded, atol=1e-12, rtol=0)
    worst = max(np.abs(np.column_stack(back.poses[i]) - np.column_stack(true.poses[frame])).max()
                for i, frame in enumerate(sorted(true.poses)))
    print(f"  imported again: poses within {worst:.1e}")
    assert worst < 1e-6, worst


def scaled(dataset, name, turn, scale, shift):
    """The data set's transforms.json with its world turned, scaled and moved."""
    file = json.loads((dataset / "transforms.json").read_text())
    for frame in file["frames"]:
        matrix = np.array(frame["transform_matrix"])
        matrix[:3] = np.column_stack([turn @ matrix[:3, :3], scale * turn @ matrix[:3, 3] + shift])
        frame["transform_matrix"] = matrix.tolist()
    (dataset / name).write_text(json.dumps(file))
    return dataset / name


def check_import_by_tags(sheen, dataset, board, poses, camera, folder):
    """Poses in axes and units of their own come back to the board that the pictures show."""
    turn = rotation(0.5, 0.5, -0.1, np.sqrt(0.49))
    file = scaled(dataset, "elsewhere.json", turn, 7.3, [1, -2, 0.5])
    report = json.loads(run(sheen, "import", file, "--mesh", dataset / "object.ply", "--board", board, "-o", folder,
                            "--json", "--quiet"))
    back, true = from_poses(folder / "poses.txt", folder / "camera.yaml"), from_poses(poses, camera)
    places = lambda views: np.array([-turn.T @ shift for turn, shift in (views.poses[i] for i in sorted(views.poses))])
    worst = 1000 * np.linalg.norm(places(back) - places(true), axis=1).max()
    scale = report["metres_per_unit"] * 7.3
    print(f"  imported by its tags: scale {scale:.6f} of the true one, cameras within {worst:.3f} mm")
    assert abs(scale - 1) < 1e-3 and worst < 1, (scale, worst)
    # The mesh follows the poses.
    place = np.reshape(json.loads((folder / "session.json").read_text())["object"]["T_stage_object"], (4, 4))
    assert np.allclose(place[:3, :3], turn.T, atol=2e-3), place


def check_masks(dataset):
    try:
        from PIL import Image
    except ImportError:
        return
    for frame in json.loads((dataset / "transforms.json").read_text())["frames"]:
        mask = np.asarray(Image.open(dataset / frame["mask_path"]))
        assert mask.ndim == 2 and set(np.unique(mask)) == {0, 255}
        assert 0.005 < (mask > 0).mean() < 0.9


def check_colmap(project, folder):
    """COLMAP's own features, triangulated from our poses."""
    if not shutil.which("colmap"):
        print("  not triangulated: colmap is not installed")
        return
    said = run("colmap", "model_analyzer", "--path", project / "sparse" / "0")
    assert re.search(rf"Registered images: {FRAMES}\b", said), said
    folder.mkdir()
    camera = next(line for line in (project / "sparse" / "0" / "cameras.txt").read_text().splitlines()
                  if not line.startswith("#")).split()
    run("colmap", "feature_extractor", "--database_path", folder / "features.db",
        "--image_path", project / "images", "--ImageReader.single_camera", 1,
        "--ImageReader.camera_model", camera[1], "--ImageReader.camera_params", ",".join(camera[4:]),
        "--SiftExtraction.use_gpu", 0, "--SiftExtraction.max_num_features", 800, "--SiftExtraction.num_threads", 1)
    run("colmap", "sequential_matcher", "--database_path", folder / "features.db", "--SiftMatching.use_gpu", 0,
        "--SequentialMatching.overlap", 3, "--SequentialMatching.quadratic_overlap", 0, "--SiftMatching.num_threads", 1)
    (folder / "model").mkdir()
    run("colmap", "point_triangulator", "--database_path", folder / "features.db", "--image_path", project / "images",
        "--input_path", project / "sparse" / "0", "--output_path", folder / "model", "--clear_points", 1,
        "--Mapper.ba_refine_focal_length", 0, "--Mapper.ba_refine_extra_params", 0)
    said = run("colmap", "model_analyzer", "--path", folder / "model")
    points = int(re.search(r"Points: (\d+)", said)[1])
    error = float(re.search(r"reprojection error: ([\d.]+)", said)[1])
    print(f"  COLMAP: {points} points, reprojection error {error:.3f} px")
    assert points > 100 and error < 1, said


def check_bundler(sheen, session, poses, choice, folder):
    """A bundle file that COLMAP's converter writes from our export brings the same poses back."""
    if not shutil.which("colmap"):
        return
    folder.mkdir()
    project, back = folder / "project", folder / "imported"
    run(sheen, "export", session, "-o", project, "--format", "colmap", "--undistort", *choice)
    run("colmap", "model_converter", "--input_path", project / "sparse" / "0", "--output_path", folder / "bundle",
        "--output_type", "Bundler")
    run(sheen, "import", folder / "bundle.bundle.out", "--images", project / "images", "--mesh", project / "object.ply",
        "-o", back)
    written, true = from_poses(back / "poses.txt", back / "camera.yaml"), from_poses(poses, session / "camera.yaml")
    worst = max(max(np.abs(written.poses[i][k] - true.poses[i][k]).max() for k in (0, 1)) for i in true.poses)
    print(f"  Bundler, by COLMAP's converter: poses within {worst:.1e}")
    # poses.txt and the bundle file keep nine digits and more of numbers up to 1.
    assert len(written.poses) == FRAMES and worst < 1e-6, worst


def check_session(sheen, session, dictionary, with_colmap, folder):
    name = session.name
    print(name)
    choice = ["--end", FRAMES, "--quiet"]
    poses = folder / f"{name}.txt"
    run(sheen, "replay", session, "-o", folder / f"{name}.glb", "--representation", "mean",
        "--poses-out", poses, *choice)
    given = from_poses(poses, session / "camera.yaml")
    corners = tag_corners(session / "board.yaml")

    plain = folder / f"{name}-nerfstudio"
    run(sheen, "export", session, "-o", plain, "--format", "nerfstudio", "--hold-out", 5, *choice)
    views = from_transforms(plain / "transforms.json")
    print(f"  transforms.json: tags within {expect_places(views, given, corners):.1e} px of the poses'")
    expect_detected("copied", plain / "images", views, corners, dictionary, 0.2)
    check_masks(plain)
    file = json.loads((plain / "transforms.json").read_text())
    assert file["orientation_override"] == "none" and file["ply_file_path"] == "object.ply"
    assert all(frame["sharpness"] > 0 for frame in file["frames"])
    held_out = [image for image in file["test_filenames"]]
    assert held_out and all(frame_of(image) % 5 == 2 for image in held_out)
    assert len(held_out) + len(file["train_filenames"]) == len(file["frames"])
    check_import(sheen, plain, poses, session / "camera.yaml", folder / f"{name}-imported")
    check_import_by_tags(sheen, plain, session / "board.yaml", poses, session / "camera.yaml", folder / f"{name}-by-tags")

    straight = folder / f"{name}-straight"
    run(sheen, "export", session, "-o", straight, "--format", "nerfstudio", "--undistort", *choice)
    views = from_transforms(straight / "transforms.json")
    assert not any(views.distortion)
    expect_detected("undistorted", straight / "images", views, corners, dictionary, 0.2)

    project = folder / f"{name}-colmap"
    run(sheen, "export", session, "-o", project, "--format", "colmap-text", *choice)
    expect_places(from_colmap_text(project / "sparse" / "0"), given, corners)
    check_import(sheen, project, poses, session / "camera.yaml", folder / f"{name}-imported-colmap")
    if with_colmap:
        check_colmap(project, folder / f"{name}-triangulated")
        check_bundler(sheen, session, poses, choice, folder / f"{name}-bundler")


def camera_numbers(session):
    data = re.findall(r"data: \[(.*?)\]", (session / "camera.yaml").read_text(), re.DOTALL)
    matrix, distortion = ([float(n) for n in numbers.split(",")] for numbers in data)
    return [matrix[0], matrix[4], matrix[2], matrix[5]], distortion


KALIBR = """cam0:
  camera_model: pinhole
  distortion_model: radtan
  distortion_coeffs: [0.0578421, -0.0805099, -0.000980296, 0.00015575]
  intrinsics: [687.76, 687.245, 276.779, 482.134]
  resolution: [540, 960]
"""


def check_real_imports(sheen, data, folder):
    """Data sets of others, with the camera and the scale given beside them."""
    if (data / "temple").exists():
        temple = data / "temple"
        run(sheen, "export", temple, "-o", folder / "temple", "--format", "nerfstudio", "--end", 8, "--quiet")
        file = scaled(folder / "temple", "units.json", np.eye(3), 12.5, 0)
        run(sheen, "import", file, "--mesh", temple / "object.ply", "--camera", temple / "camera.yaml",
            "--known-distance", 12.5, 1, "-o", folder / "temple-back", "--quiet")
        back = np.loadtxt(folder / "temple-back" / "poses.txt")
        assert np.abs(back[:, :4] - np.loadtxt(temple / "poses.txt")[:8, :4]).max() < 1e-6
        assert camera_numbers(folder / "temple-back")[0] == camera_numbers(temple)[0]
        print("temple: comes back with --camera and --known-distance")
    if (data / "fox").exists():
        (folder / "camchain.yaml").write_text(KALIBR)
        mesh = folder / "triangle.ply"
        mesh.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        for name, options in {"fox-own": [], "fox-kalibr": ["--camera", folder / "camchain.yaml"]}.items():
            run(sheen, "import", data / "fox" / "transforms.json", "--mesh", mesh, "--known-distance", 4, 0.5, *options,
                "-o", folder / name, "--quiet")
            frames = sorted(json.loads((data / "fox" / "transforms.json").read_text())["frames"], key=lambda f: f["file_path"])
            places = [np.array(frame["transform_matrix"])[:3, 3] / 8 for frame in frames]
            assert np.abs(np.loadtxt(folder / name / "poses.txt")[:, 1:4] - places).max() < 1e-6
        # The file's own camera and Kalibr's are one: half a pixel apart by their conventions.
        assert np.allclose(camera_numbers(folder / "fox-own")[0], camera_numbers(folder / "fox-kalibr")[0], atol=1e-9)
        assert np.allclose(camera_numbers(folder / "fox-own")[1][:4], camera_numbers(folder / "fox-kalibr")[1][:4])
        print("fox: imported, its own camera and Kalibr's file of the same give one session")


def check_refusals(sheen, session, folder):
    """Exit code 2 and one line, and what is there stays."""
    there = folder / "there"
    there.mkdir()
    (there / "mine").write_text("mine")
    for arguments, word in [([session, "-o", there, "--format", "colmap"], "exists already"),
                            ([session, "-o", folder / "new"], "--format nerfstudio or colmap"),
                            ([session / "object.ply", "-o", folder / "new", "--format", "colmap"], "for sessions")]:
        done = subprocess.run([sheen, "export", *arguments, "--quiet"], capture_output=True, text=True)
        assert done.returncode == 2 and word in done.stderr and done.stderr.count("\n") == 1, done.stderr
        assert not (folder / "new").exists() and (there / "mine").read_text() == "mine"


def main():
    sheen, repository = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    box = repository.parent / "shared" / "data" / "box"
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        folder.mkdir(exist_ok=True)
        check_refusals(sheen, repository / "sample_data" / "glossy", folder)
        check_session(sheen, repository / "sample_data" / "glossy", "DICT_APRILTAG_36h11", False, folder)
        check_real_imports(sheen, box.parent, folder)
        if box.exists():
            check_session(sheen, box, "DICT_6X6_250", True, folder)
        else:
            print(f"box: no {box}")


main()
