#!/usr/bin/env python3
"""Writes the table of docs/reference/hashes.md from the results of all platforms: hash_table.py FOLDER PAGE.

FOLDER has for each platform NAME.name (its title) and either NAME.lines ("scene ticks hash threads") or NAME.missing
(the reason for skipping it). NAME.own has the reason if a platform is expected to have different hashes.
Exit code 1: a hash differs from tests/golden/hashes.txt (or, with NAME.own, between numbers of threads), or a scene is
missing.
"""
import datetime
import pathlib
import subprocess
import sys
import textwrap

SHOW = "show.take"  # one test plays it with each number of threads
MARK = "<!-- made by ./check --long hashes -->"


def golden_table():
    table = {}
    for line in pathlib.Path("tests/golden/hashes.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, ticks, value = line.split()
            table[name] = (ticks, value)
    return table


def read_lines(file):
    by_threads = {}
    for line in file.read_text().splitlines():
        name, ticks, value, threads = line.split()
        by_threads.setdefault(int(threads), {})[name] = (ticks, value)
    return by_threads


def main():
    folder, page = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    golden = golden_table()
    rows, differing, left_out, notes = [], [], [], []
    for file in sorted(folder.glob("*.name"), key=lambda f: f.stat().st_mtime_ns):
        platform = file.read_text().strip()
        lines, missing = file.with_suffix(".lines"), file.with_suffix(".missing")
        if missing.exists() or not lines.exists():
            left_out.append((platform, missing.read_text().strip() if missing.exists() else "it did not play"))
            continue
        cells = []
        by_threads, own = read_lines(lines), file.with_suffix(".own")
        expected = golden
        if own.exists():
            expected = by_threads.get(min(by_threads), {})
            notes.append((platform, own.read_text().strip()))
        for threads in (1, 2, 3):
            found = by_threads.get(threads)
            if found is None:
                cells.append("")
                continue
            wanted = [SHOW] if set(found) == {SHOW} else list(golden)
            equal = [name for name in wanted if found.get(name) == golden[name]]
            cells.append(f"{len(equal)} of {len(wanted)}" + (" (the show alone)" if wanted == [SHOW] else ""))
            for name in wanted:
                if name not in found or found[name] != expected.get(name):
                    got = " ".join(found[name]) if name in found else "it did not end"
                    differing.append((platform, threads, name, " ".join(expected.get(name, ("?",))), got))
        rows.append((platform, cells))
    commit = subprocess.run(["git", "rev-parse", "--short=10", "HEAD"], capture_output=True, text=True).stdout.strip()
    text = [MARK, "", f"Commit {commit}, {datetime.date.today().isoformat()}. Each cell: number of equal golden hashes "
            "of all (the scenes and the recorded show).", "",
            "| platform | 1 thread | 2 threads | 3 threads |", "|---|---|---|---|"]
    text += ["| " + " | ".join([platform] + cells) + " |" for platform, cells in rows]
    if notes:
        texts = [f"{platform}: different hashes, equal for all numbers of threads. {why}." for platform, why in notes]
        text += [""] + [textwrap.fill(note, 120, break_long_words=False, break_on_hyphens=False) for note in texts]
    text += ["", "## Differences", ""]
    if differing:
        text += ["| platform | threads | scene | expected | here |", "|---|---|---|---|---|"]
        text += ["| " + " | ".join(map(str, row)) + " |" for row in differing]
    else:
        text.append("None.")
    text += ["", "## Left out", ""]
    text += [f"- {platform}: {why}" for platform, why in left_out] or ["Nothing."]
    head = page.read_text().split(MARK)[0] if page.exists() else "# Hashes\n\n"
    page.write_text(head + "\n".join(text) + "\n")
    for platform, threads, name, _, _ in differing[:10]:
        print(f"{platform}, {threads} threads: {name}")
    print(f"{len(rows)} platforms, {len(differing)} differences, {len(left_out)} left out: {page}")
    return 1 if differing or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
