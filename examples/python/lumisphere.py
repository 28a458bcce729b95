#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws how patches of a surface look from every direction: their lumispheres.

    examples/python/lumisphere.py sample_data/glossy lumispheres.png
"""
import sys

import matplotlib
import numpy as np

import sheen

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def tangents(normal):
    """Two unit vectors that complete a normal to an orthonormal frame."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    tangent = np.cross(helper, normal)
    tangent /= np.linalg.norm(tangent)
    return tangent, np.cross(normal, tangent)


def lumisphere(model, patch, size=96):
    """Image (size, size, 4) of the hemisphere of directions seen from above the patch."""
    axis = np.linspace(-1, 1, size)
    x, y = np.meshgrid(axis, -axis)
    inside = x**2 + y**2 < 1
    z = np.sqrt(np.where(inside, 1 - x**2 - y**2, 0))
    normal = model.normals[patch]
    tangent, bitangent = tangents(normal)
    directions = x[..., None] * tangent + y[..., None] * bitangent + z[..., None] * normal
    colours = model.evaluate(np.full(size * size, patch), directions.reshape(-1, 3))
    return np.dstack([np.clip(colours, 0, 1).reshape(size, size, 3), inside])


def main(session, picture):
    model = sheen.reconstruct(
        sheen.open_session(session), threads=2,
        progress=lambda step, done, total: print(f"\r{step} {done}/{total or '?'}", end=""))
    print()
    seen = np.flatnonzero(model.observed)
    patches = seen[np.linspace(0, len(seen) - 1, 12).astype(int)]
    figure, axes = plt.subplots(2, 6, figsize=(12, 4.4))
    for axis, patch in zip(axes.flat, patches):
        axis.imshow(lumisphere(model, patch), interpolation="bilinear")
        axis.set_title(f"patch {patch}", fontsize=9)
        axis.axis("off")
    figure.suptitle("The same places from every direction; the middle of a disc is straight above")
    figure.tight_layout()
    figure.savefig(picture, dpi=120)
    print("written", picture)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
