#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails on an #include that climbs: headers escape CMake's check for cycles between modules.

The tables are those of docs/architecture.md. Usage: includes_test.py REPOSITORY
"""
import pathlib
import re
import sys

# A module -> the modules whose headers it may include.
MODULES = {
    "core": {"core"},
    "capture": {"core", "capture"},
    "fitting": {"core", "fitting"},
    "reconstruction": {"core", "capture", "reconstruction"},
    "exporters": {"core", "fitting", "exporters"},
    "render": {"core", "fitting", "render"},
    "pipeline": {"core", "capture", "fitting", "pipeline"},
    "evaluation": {"core", "capture", "fitting", "render", "pipeline", "evaluation"},
    "app": {"core", "capture", "fitting", "reconstruction", "exporters", "render", "pipeline", "evaluation", "app"},
}
# Programs that measure, proofs, bindings: whatever they look at, and their own. No module may include
# them.
MODULES["bench"] = MODULES["app"] | {"bench"}
MODULES["python"] = MODULES["pipeline"] | {"render", "python"}
MODULES["tests"] = MODULES["bench"] | {"tests"}

# Libraries that are met in some places only: pattern of the include -> folders. Proofs may use any.
LIBRARIES = {
    r"GL/|EGL/|OSMesa|epoxy": {"render"},
    r"CLI/": {"app/command_line", "bench"},
    r"apriltag/|opencv2/(calib3d|videoio|aruco)": {"capture", "bench/micro"},
    r"embree3/|draco/|libqhull": {"core"},
    r"meshoptimizer": {"core", "bench"},  # bench decimates meshes, the program does not
    r"libav|libsw|lcms2|pugixml": {"capture"},
    r"nlohmann/": set(MODULES) - {"pipeline"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def lies_in(source, folders):
    return any(source.is_relative_to(folder) for folder in folders)


def faults_of(source, text, module):
    """What is wrong with the includes of `source`, a path from the repository's root."""
    for kind, target in INCLUDE.findall(text):
        owner = target.split("/")[0]
        if kind == '"' and owner not in MODULES[module]:
            yield f"{source} includes {target}: {module} may only use {sorted(MODULES[module])}"
        if kind == "<" and owner in MODULES:
            yield f"{source} includes <{target}>: our own headers stand in quotes"
        for pattern, folders in LIBRARIES.items():
            if re.match(pattern, target) and not lies_in(source, folders | {"tests"}):
                yield f"{source} includes {target}, which belongs to {sorted(folders)}"


def faults(repository):
    for module in MODULES:
        sources = [p for p in (repository / module).rglob("*") if p.suffix in {".h", ".cpp"}]
        assert sources, f"module {module} has no sources: is {repository} the repository?"
        for source in sources:
            yield from faults_of(source.relative_to(repository), source.read_text(), module)


def check_the_check():
    """Includes that must be found, and some that must not."""
    def is_fault(source, include):
        path = pathlib.PurePosixPath(source)
        return any(faults_of(path, f"#include {include}\n", path.parts[0]))

    for source, include in [("pipeline/a.h", "<CLI/CLI.hpp>"), ("pipeline/a.h", "<nlohmann/json.hpp>"),
                            ("pipeline/a.cpp", "<GL/gl.h>"), ("pipeline/a.cpp", '"render/renderer.h"'),
                            ("app/commands/a.cpp", "<CLI/CLI.hpp>"), ("app/a.cpp", '"bench/report/program.h"'),
                            ("evaluation/a.cpp", '"app/progress.h"'), ("capture/a.h", '"fitting/fitter.h"'),
                            ("render/a.h", '"capture/session/session.h"'), ("app/a.cpp", "<opencv2/videoio.hpp>"),
                            ("core/a.h", "<core/mesh/mesh.h>"), ("fitting/a.cpp", '"tests/core/shapes.h"')]:
        assert is_fault(source, include), f"{source} may include {include}"
    for source, include in [("app/command_line/a.cpp", "<CLI/CLI.hpp>"), ("bench/a.cpp", '"app/progress.h"'),
                            ("tests/capture/a.cpp", "<apriltag/apriltag.h>"), ("pipeline/a.h", "<vector>"),
                            ("evaluation/a.h", '"pipeline/options.h"'), ("render/a.h", "<GL/glcorearb.h>")]:
        assert not is_fault(source, include), f"{source} may not include {include}"


check_the_check()
found = list(faults(pathlib.Path(sys.argv[1])))
print("\n".join(found) or "every include looks down")
sys.exit(bool(found))
