#!/usr/bin/env python3
"""Copies the last commit into a folder, with mutations planted in its sources.

Unchanged files keep their modification times, so that builds of the folder are incremental.
"""
import argparse
import io
import pathlib
import re
import subprocess
import sys
import tarfile

import mutations

HERE = pathlib.Path(__file__).parent
SWITCH_HEADER = "src/base/mutation_switch.h"


def committed_files():
    """Returns {path: (bytes, mode)} of the last commit."""
    archive = subprocess.run(["git", "archive", "HEAD"], check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        return {entry.name: (tar.extractfile(entry).read(), entry.mode) for entry in tar if entry.isfile()}


def synchronize(folder, files):
    """Makes the folder, except build/ and shared/, contain exactly these files."""
    for path in folder.rglob("*"):
        relative = path.relative_to(folder)
        if relative.parts[0] not in ("build", "shared") and path.is_file() and str(relative) not in files:
            path.unlink()
    for name, (content, mode) in files.items():
        path = folder / name
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        path.chmod(mode)


def mutate_text(text, mutation):
    """Returns the text of a file that is not C++ with its mutation; white space within the searched text doesn't matter."""
    pattern = r"\s+".join(re.escape(word) for word in mutation.replace.split())
    changed, count = re.subn(pattern, lambda match: mutation.by.rstrip("\n"), text)
    if count != 1:
        raise mutations.MutationError(f"{mutation.place}: {mutation.name}: found {count} times in {mutation.target}")
    return changed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=pathlib.Path, help="default: only check that each mutation finds its place")
    parser.add_argument("--table", type=pathlib.Path, help="write a line for each mutation to this file: name, alone or together, tests, fault")
    parser.add_argument("--alone", help="plant this mutation of a file that is not C++")
    parser.add_argument("names", nargs="*", help="beginnings of names; default: all")
    options = parser.parse_args()
    chosen = [m for path in sorted(HERE.glob("*.txt")) for m in mutations.read(path)
              if not options.names or m.name.startswith(tuple(options.names))]
    if not chosen:
        raise mutations.MutationError(f"no mutation's name starts with {' or '.join(options.names)}")
    files = committed_files()
    sources = mutations.Sources(
        {name: content.decode() for name, (content, _) in files.items() if re.fullmatch(r"src/.*\.(cpp|h)", name)}
    )
    alone = {m.name: (m.target, mutate_text(files[m.target][0].decode(), m)) for m in chosen if m.alone}
    planted = mutations.plant(sources, [m for m in chosen if not m.alone])
    if options.folder is None:
        print(f"{len(chosen)} mutations find their place")
        return
    for path, text in planted.items():
        files[path] = (('#include "base/mutation_switch.h"\n' + text).encode(), files[path][1])
    files[SWITCH_HEADER] = (mutations.SWITCH.encode(), 0o644)
    if options.alone:
        path, text = alone[options.alone]
        files[path] = (text.encode(), files[path][1])
    synchronize(options.folder, files)
    if options.table:
        options.table.write_text("".join(
            f"{m.name}\t{'alone' if m.alone else 'together'}\t{';'.join('|'.join(t) for t in m.tests)}\t{m.fault}\n" for m in chosen))


if __name__ == "__main__":
    try:
        main()
    except mutations.MutationError as error:
        sys.exit(f"plant.py: {error}")
