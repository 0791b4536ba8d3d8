#!/usr/bin/env python3
"""Generates the models of this folder: *.urdf, meshes/*.stl, and the tables in docs/reference/models.md.

    python3 urdf/make_models.py            writes all files; the output is deterministic
    python3 urdf/make_models.py --check    compares with the existing files; exits with 1 if one differs
"""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True  # leaves no caches in the tree

from kit.models import MODELS
from kit.parts import PARTS
from kit.solid import stl_bytes
from kit.tables import fill

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "reference" / "models.md"


def everything():
    """All files that this script generates, with their bytes."""
    robots = [make() for make in MODELS]
    files = {HERE / "meshes" / f"{name}.stl": stl_bytes(part[0]) for name, part in PARTS.items()}
    files.update({HERE / f"{robot.name}.urdf": robot.xml().encode() for robot in robots})
    files[PAGE] = fill(PAGE.read_text(encoding="utf-8"), robots).encode()
    return files


def main():
    parser = argparse.ArgumentParser(description="Writes the models of this folder.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 when a file differs")
    check = parser.parse_args().check
    files, stale = everything(), []
    for path, data in files.items():
        if path.exists() and path.read_bytes() == data:
            continue
        stale.append(path)
        if not check:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
    # files of models and meshes that are no longer generated
    lost = [p for p in [*HERE.glob("*.urdf"), *HERE.glob("meshes/*.stl")] if p not in files]
    for path in stale + lost:
        verb = "differs: run urdf/make_models.py" if check else "written"
        verb = "is not made here: remove it" if path in lost else verb
        print(f"{path.relative_to(HERE.parent)}: {verb}")
    return 1 if check and (stale or lost) else 0


if __name__ == "__main__":
    sys.exit(main())
