# SPDX-License-Identifier: MIT
"""The module `sheen` as a program outside the build tree sees it. SHEEN_SESSION names a session."""
import os
import pathlib
import tempfile
import unittest

import numpy as np

import sheen

SESSION = os.environ["SHEEN_SESSION"]
FRAMES = 30


class Module(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = sheen.open_session(SESSION)
        cls.steps = []
        cls.model = sheen.reconstruct(
            cls.session, end=FRAMES, threads=2,
            progress=lambda step, done, total: cls.steps.append((step, done, total)))

    def test_tells_of_every_frame_in_order(self):
        fitting = [(done, total) for step, done, total in self.steps if step == "fitting"]
        self.assertEqual(fitting, [(i + 1, FRAMES) for i in range(FRAMES)])
        self.assertEqual(self.model.frames["posed"], FRAMES)

    def test_session_says_what_its_files_say(self):
        # sample_data/glossy/camera.yaml: 640x360, square pixels.
        self.assertEqual(self.session.image_size, (640, 360))
        K = self.session.camera_matrix
        self.assertEqual(K[2, 2], 1)
        self.assertAlmostEqual(K[0, 0] / K[1, 1], 1, places=2)
        R = self.session.board_from_object[:3, :3]
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)

    def test_arrays_are_views_that_nobody_can_write(self):
        for name in ("positions", "normals", "triangles", "observed"):
            array = getattr(self.model, name)
            self.assertFalse(array.flags.owndata, name)
            self.assertFalse(array.flags.writeable, name)
            again = getattr(self.model, name)
            self.assertEqual(array.ctypes.data, again.ctypes.data, name)
        self.assertLess(self.model.triangles.max(), len(self.model.positions))

    def test_arrays_outlive_the_model(self):
        def coefficients():
            model = sheen.reconstruct(self.session, representation="mean", end=3)
            return model.coefficients["coefficients"], model.positions
        colours, positions = coefficients()
        self.assertEqual(colours.size, 3 * len(positions))
        self.assertTrue(np.isfinite(colours.astype(float)).all())

    def test_mean_colours_are_the_same_in_all_directions(self):
        model = sheen.reconstruct(self.session, representation="mean", end=3)
        patch = int(np.flatnonzero(model.observed)[0])
        normal = model.normals[patch]
        colours = model.evaluate([patch, patch], [normal, np.roll(normal, 1)])
        np.testing.assert_array_equal(colours[0], colours[1])
        np.testing.assert_allclose(colours[0], model.vertex_colours[patch], atol=1e-6)

    def test_a_model_comes_back_from_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "model.glb"
            self.model.write(path)
            back = sheen.read_model(path)
            self.assertIsNone(back.frames)
            self.assertEqual(back.representation, "detail")
            np.testing.assert_array_equal(back.positions, self.model.positions)
            patches = np.arange(0, back.patch_count, 7)
            np.testing.assert_array_equal(back.evaluate(patches, back.normals[patches]),
                                          self.model.evaluate(patches, back.normals[patches]))

    def test_options_are_those_of_the_command_line(self):
        model = sheen.reconstruct(self.session, representation="iwls",
                                  options={"fitter": "batch", "centers": "16"}, end=3)
        self.assertEqual(model.representation, "iwls")
        with self.assertRaisesRegex(ValueError, "--tolerance is no option of representation iwls"):
            sheen.reconstruct(self.session, representation="iwls", options={"tolerance": "0.1"})

    def test_errors_keep_their_one_line(self):
        with self.assertRaises(sheen.InputError) as caught:
            sheen.open_session("/nowhere")
        self.assertIn("/nowhere", str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)

    def test_progress_can_end_the_work(self):
        class Enough(Exception):
            pass

        def stop(step, done, total):
            if step == "fitting" and done == 2:
                raise Enough
        with self.assertRaises(Enough):
            sheen.reconstruct(self.session, progress=stop, threads=2)

    def test_wrong_shapes_are_refused(self):
        with self.assertRaisesRegex(ValueError, "shape"):
            self.model.evaluate([0, 1], [[0, 0, 1]])
        with self.assertRaises(IndexError):
            self.model.evaluate([self.model.patch_count], [[0, 0, 1]])

    def test_everything_public_is_documented(self):
        for name in ("open_session", "read_model", "reconstruct", "Model", "Session"):
            self.assertTrue(getattr(sheen, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
