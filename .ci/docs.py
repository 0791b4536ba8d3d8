#!/usr/bin/env python3
"""Checks the Markdown pages: width, length, links, and that the navigation of the site contains every page.

    .ci/docs.py [FOLDER]    checks the repository in FOLDER (default: this one); prints path:line of each finding

mkdocs and .ci/package/site_links.py check the site that is built from the pages.
"""
import pathlib
import re
import subprocess
import sys

WIDTH = 120  # columns
LENGTH = 400  # lines
CELL = 1000  # characters
# lists that grow by their nature, and the map of the sources, which is one page so that a search finds everything
LONG = {"CHANGELOG.md", "src/README.md"}
# Generated pages, and the generated rest of a page after a mark: neither counts for the length, and tables may be wide.
GENERATED = re.compile(r"docs/reference/(lua/.*|command_line|osc_addresses)\.md$")
MARK = re.compile(r"<!-- (reference|made by .*) -->$")
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")


def pages_of(root):
    """Paths of all Markdown files, tracked or new."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=root, capture_output=True,
                            text=True, check=False)
    if listed.returncode == 0:
        return sorted(name for name in set(listed.stdout.split()) if (root / name).exists())
    return sorted(path.relative_to(root).as_posix() for path in root.rglob("*.md") if "build" not in path.parts)


def slug(heading):
    """Anchor of a heading on GitHub."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).strip().replace(" ", "-")


def headings(lines):
    code, found = False, []
    for line in lines:
        if line.startswith("```"):
            code = not code
        elif not code and re.match(r"#{1,6} ", line):
            found.append(slug(line.lstrip("#")))
    return found


def line_faults(name, lines):
    generated = bool(GENERATED.match(name))
    written = 0
    for number, line in enumerate(lines, 1):
        generated = generated or bool(MARK.match(line))
        written += not generated
        if len(line) > WIDTH and not (generated and line.startswith("|")):
            yield f"{name}:{number}: {len(line)} columns, at most {WIDTH}"
        if line.startswith("|") and max(map(len, re.split(r"(?<!\\)\|", line))) >= CELL:
            yield f"{name}:{number}: a cell of {CELL} characters or more; use a list or a section"
    if written > LENGTH and name not in LONG:
        yield f"{name}: {written} lines, at most {LENGTH}; divide the page"


def link_faults(root, name, lines, anchors):
    code = False
    for number, line in enumerate(lines, 1):
        if line.startswith("```"):
            code = not code
        if code or line.startswith("    "):
            continue
        for target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, mark = target.partition("#")
            path = ((root / name).parent / file).resolve() if file else (root / name).resolve()
            if not path.exists():
                yield f"{name}:{number}: there is no {target}"
            elif mark and mark not in anchors.get(path, [mark]):
                yield f"{name}:{number}: {file or name} has no #{mark}"


def nav_faults(root, names):
    """Pages that the navigation or the index page of their folder lacks."""
    settings = (root / "mkdocs.yml").read_text(encoding="utf-8")
    nav = set(re.findall(r"^ *- (?:[^#\n]*: )?(\S+\.md)", settings, re.MULTILINE))
    for name in names:
        if not name.startswith("docs/"):
            continue
        if name.removeprefix("docs/") not in nav:
            yield f"{name}: the navigation in mkdocs.yml lacks it"
        page = pathlib.PurePosixPath(name)
        index = root / page.parent / "index.md"
        if page.name != "index.md" and page.parent.as_posix() != "docs/reference/lua":
            text = index.read_text(encoding="utf-8") if index.exists() else ""
            if not re.search(rf"\]\({re.escape(page.name)}[)#]", text):
                yield f"{name}: {page.parent}/index.md has no link to it"


def faults(root):
    names = pages_of(root)
    texts = {name: (root / name).read_text(encoding="utf-8").splitlines() for name in names}
    anchors = {(root / name).resolve(): headings(lines) for name, lines in texts.items()}
    for name, lines in texts.items():
        yield from line_faults(name, lines)
        yield from link_faults(root, name, lines, anchors)
    yield from nav_faults(root, names)


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent
    found = list(faults(folder.resolve()))
    print("\n".join([*found, f"{len(found)} findings"]))
    sys.exit(1 if found else 0)
