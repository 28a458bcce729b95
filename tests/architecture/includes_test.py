#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails on an #include that climbs: headers escape CMake's check for cycles between modules.

The table is the one of docs/architecture.md. Usage: includes_test.py REPOSITORY
"""
import pathlib
import re
import sys

MODULES = {
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
# Libraries that may be met in some modules only: pattern of the include -> modules.
LIBRARIES = {
    r"GL/|OSMesa|epoxy": {"render"},
    r"apriltag/|opencv2/(calib3d|videoio|aruco)": {"capture", "bench/micro"},
    r"assimp/|embree3/": {"core"},
    r"CLI/": {"app", "bench", "bench/pipeline", "bench/preview"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def module_of(source):
    """The innermost module that holds a source."""
    return max((module for module in MODULES if source.as_posix().startswith(module + "/")), key=len)


def faults(repository):
    for module, allowed in MODULES.items():
        sources = [p for p in (repository / module).rglob("*")
                   if p.suffix in {".h", ".cpp"} and module_of(p.relative_to(repository)) == module]
        assert sources, f"module {module} has no sources: is {repository} the repository?"
        for source in sources:
            for kind, target in INCLUDE.findall(source.read_text()):
                name = source.relative_to(repository)
                if kind == '"' and target.split("/")[0] not in allowed:
                    yield f"{name} includes {target}: {module} may only use {sorted(allowed)}"
                for pattern, modules in LIBRARIES.items():
                    if kind == "<" and re.match(pattern, target) and module not in modules:
                        yield f"{name} includes <{target}>, which belongs to {sorted(modules)}"


found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "every include looks down")
sys.exit(bool(found))
