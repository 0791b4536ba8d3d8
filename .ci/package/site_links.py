"""Checks the built documentation: each internal link has a target, and nothing is loaded from the network.

Usage: site_links.py FOLDER PAGES, where PAGES is the folder of the Markdown pages. Prints all errors; exit code 1 if there are any.
"""
import html.parser
import pathlib
import sys


class Page(html.parser.HTMLParser):
    """The links, the loaded files and the anchors of one page."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loaded, self.marks = [], [], set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.marks.update(v for k, v in attrs.items() if k in ("id", "name"))
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        elif attrs.get("href") or attrs.get("src"):
            self.loaded.append(attrs.get("href") or attrs.get("src"))


def faults(folder, pages):
    parsed = {file.name: Page(file) for file in sorted(folder.glob("*.html"))}
    index = parsed["index.html"].links
    for source in sorted(pages.glob("*.md")):
        name = source.with_suffix(".html").name
        if name not in parsed:
            yield f"{source.name} has no page"
        elif name != "index.html" and name not in index:
            yield f"index.html has no link to {name}"
    for name, page in parsed.items():
        for target in page.loaded:
            if "://" in target or target.startswith("//") or not (folder / target).exists():
                yield f"{name} loads {target}"
        for target in page.links:
            if "://" in target or target.startswith("mailto:"):
                continue
            file, _, mark = target.partition("#")
            file = file or name
            if not (folder / file).exists():
                yield f"{name}: there is no {file}"
            elif mark and file in parsed and mark not in parsed[file].marks:
                yield f"{name}: {file} has no #{mark}"


found = list(faults(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
print("\n".join(found))
sys.exit(1 if found else 0)
