#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Copies a recording (MJPEG in AVI, as `sheen synth` writes it) with its light multiplied.

Codes are multiplied in linear light and stored as JPEG of quality 93 again. What `sheen merge` finds
between walks of different exposure is compared with what was applied here (docs/states.md).

Usage: relight.py IN.avi OUT.avi [--gain R G B] [--cut-off]
"""
import argparse
import io
import struct

import numpy
from PIL import Image


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--gain", nargs=3, type=float, default=[0.7, 0.85, 1.1])
    parser.add_argument("--cut-off", action="store_true", help="codes are cut off, not rounded")
    return parser.parse_args()


def code_tables(gains, to_whole):
    code = numpy.arange(256) / 255
    light = numpy.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)

    def encoded(value):
        curved = 1.055 * value ** (1 / 2.4) - 0.055
        return numpy.where(value <= 0.0031308, value * 12.92, curved).clip(0, 1)

    return [to_whole(255 * encoded(gain * light)).astype(numpy.uint8) for gain in gains]


def relit(jpeg, tables):
    image = numpy.asarray(Image.open(io.BytesIO(jpeg)).convert("RGB"))
    channels = [table[image[..., k]] for k, table in enumerate(tables)]
    stored = io.BytesIO()
    Image.fromarray(numpy.stack(channels, -1)).save(stored, "JPEG", quality=93)
    return stored.getvalue()


def main():
    chosen = options()
    tables = code_tables(chosen.gain, numpy.floor if chosen.cut_off else numpy.round)
    with open(chosen.input, "rb") as file:
        data = file.read()
    movi = data.find(b"movi")
    end = movi + struct.unpack_from("<I", data, movi - 4)[0]
    at, frames, places = movi + 4, b"", []
    while at + 8 <= end:
        tag, size = struct.unpack_from("<4sI", data, at)
        if tag == b"00dc":
            jpeg = relit(data[at + 8:at + 8 + size], tables)
            places.append((4 + len(frames), len(jpeg)))
            frames += struct.pack("<4sI", tag, len(jpeg)) + jpeg + b"\0" * (len(jpeg) % 2)
        at += 8 + size + size % 2
    index = b"".join(struct.pack("<4sIII", b"00dc", 16, *place) for place in places)
    copy = data[:movi - 4] + struct.pack("<I", 4 + len(frames)) + b"movi" + frames
    copy += struct.pack("<4sI", b"idx1", len(index)) + index
    with open(chosen.output, "wb") as file:
        file.write(copy[:4] + struct.pack("<I", len(copy) - 8) + copy[8:])


if __name__ == "__main__":
    main()
