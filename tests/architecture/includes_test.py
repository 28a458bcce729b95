#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails on an #include that climbs: headers escape CMake's check for cycles between rooms.

The table is the one of docs/architecture.md. Usage: includes_test.py REPOSITORY
"""
import pathlib
import re
import sys

ROOMS = {
    "core": {"core"},
    "capture": {"core", "capture"},
    "fitting": {"core", "fitting"},
    "render": {"core", "fitting", "render"},
    "bench": {"core", "fitting", "bench"},
    "bench/micro": {"core", "capture", "fitting", "render", "bench"},  # programs that measure a stage
    "bench/pipeline": {"core", "capture", "fitting", "render", "bench", "app"},  # the whole pipeline
    "bench/preview": {"core", "capture", "fitting", "render", "bench", "app"},  # the window over it
    "app": {"core", "capture", "fitting", "render", "bench", "app"},
}
# Libraries that may be met in some rooms only: pattern of the include -> rooms.
LIBRARIES = {
    r"GL/|OSMesa|epoxy": {"render"},
    r"apriltag/|opencv2/(calib3d|videoio|aruco)": {"capture", "bench/micro"},
    r"assimp/|embree3/": {"core"},
    r"CLI/": {"app", "bench", "bench/pipeline", "bench/preview"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def room_of(source):
    """The innermost room that holds a source."""
    return max((room for room in ROOMS if source.as_posix().startswith(room + "/")), key=len)


def faults(repository):
    for room, allowed in ROOMS.items():
        sources = [p for p in (repository / room).rglob("*")
                   if p.suffix in {".h", ".cpp"} and room_of(p.relative_to(repository)) == room]
        assert sources, f"room {room} has no sources: is {repository} the repository?"
        for source in sources:
            for kind, target in INCLUDE.findall(source.read_text()):
                name = source.relative_to(repository)
                if kind == '"' and target.split("/")[0] not in allowed:
                    yield f"{name} includes {target}: {room} may only use {sorted(allowed)}"
                for pattern, rooms in LIBRARIES.items():
                    if kind == "<" and re.match(pattern, target) and room not in rooms:
                        yield f"{name} includes <{target}>, which belongs to {sorted(rooms)}"


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "every include looks down")
sys.exit(bool(found))
