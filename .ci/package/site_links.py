"""Checks the built documentation: each internal link has a target, and nothing is loaded from another host.

Usage: site_links.py FOLDER PAGES, where PAGES is the folder of the Markdown pages. Prints all errors; exit code 1 if
there are any. Links to other hosts are allowed as `<a href>` only: a page must not request anything when it is shown.
"""
import html.parser
import json
import pathlib
import re
import sys
import urllib.parse

# attributes that make a browser load something, or that send something
LOADING = {
    "src", "srcset", "href", "xlink:href", "poster", "data", "action", "formaction", "background", "ping", "manifest"
}
# functions that request something; the search loads scripts of the site by `src`
REQUESTS = (r"\bfetch\s*\(|\bimport\s*\(|^\s*import\b|importScripts|XMLHttpRequest|WebSocket|EventSource|sendBeacon"
            r"|\bWorker\s*\(")
INDEX = "const limberPages = "


def is_foreign(address):
    """True if the address has a host or a scheme, apart from data in the address itself."""
    return bool(re.match(r"\s*(//|(?!data:)[a-z][a-z0-9+.-]*:)", address, re.IGNORECASE))


def style_faults(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    for address in re.findall(r"url\(\s*['\"]?([^'\")]*)", text) + re.findall(r"@import\s+['\"]([^'\"]*)", text):
        if is_foreign(address):
            yield f"a style loads {address}"


def script_faults(text):
    if text.startswith(INDEX):
        json.loads(text.removeprefix(INDEX).rstrip().rstrip(";"))  # data alone
        return
    text = re.sub(r"/\*.*?\*/|(?<![:'\"])//[^\n]*", "", text, flags=re.DOTALL)
    for call in re.findall(REQUESTS, text, re.MULTILINE):
        yield f"a script requests something: {call.strip()}"
    for address in re.findall(r"['\"`]((?:https?:|wss?:)?//[^'\"`\s]+)", text):
        yield f"a script names the address {address}"


class Page(html.parser.HTMLParser):
    """The links, the loaded files, the anchors of one page, and its references to other hosts."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.marks, self.faults, self.inside = [], [], set(), [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.inside = tag if tag in ("style", "script") else ""
        for key, value in attrs:
            value = value or ""
            if key in ("id", "name"):
                self.marks.add(value)
            elif tag == "a" and key == "href":
                self.links.append(value)
                if is_foreign(value) and not re.match(r"(https?|mailto):", value):
                    self.faults.append(f"links to {value}")
            elif key in LOADING:
                parts = [part.split()[0] for part in value.split(",") if part.strip()]
                self.loaded += parts if key == "srcset" else [value]
            elif key == "style":
                self.faults += style_faults(value)
            elif key.startswith("on"):
                self.faults += script_faults(value)
            elif tag == "meta" and key == "http-equiv" and value.lower() == "refresh":
                self.faults.append("a page must not refresh itself")

    def handle_endtag(self, tag):
        self.inside = ""

    def handle_data(self, data):
        if self.inside == "style":
            self.faults += style_faults(data)
        elif self.inside == "script":
            self.faults += script_faults(data)


def markup_faults(folder):
    """The pages by path, and what they and the other files load from elsewhere."""
    pages, found = {}, []
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = file.relative_to(folder).as_posix()
        if file.suffix in (".html", ".svg"):
            pages[name] = Page(file.read_text(encoding="utf-8"))
            found += [f"{name}: {fault}" for fault in pages[name].faults]
        elif file.suffix == ".css":
            found += [f"{name}: {fault}" for fault in style_faults(file.read_text(encoding="utf-8"))]
        elif file.suffix in (".js", ".mjs"):
            found += [f"{name}: {fault}" for fault in script_faults(file.read_text(encoding="utf-8"))]
    return pages, found


def link_faults(folder, pages):
    """References from page to page that have no target."""
    for name, page in pages.items():
        here = (folder / name).parent
        for target in page.loaded:
            if target.startswith("data:"):
                continue
            file = target.partition("#")[0]
            if is_foreign(target) or (file and not (here / file).is_file()):
                yield f"{name} loads {target}"
        for target in page.links:
            if is_foreign(target):
                continue
            file, _, mark = urllib.parse.unquote(target).partition("#")
            path = (here / file).resolve() if file else folder / name
            if folder not in path.parents or not path.is_file():
                yield f"{name}: there is no {file}"
                continue
            there = path.relative_to(folder).as_posix()
            if mark and there in pages and mark not in pages[there].marks:
                yield f"{name}: {there} has no #{mark}"


def faults(folder, sources):
    folder = folder.resolve()
    pages, found = markup_faults(folder)
    for source in sorted(sources.rglob("*.md")):
        name = source.relative_to(sources).with_suffix(".html").as_posix()
        if name not in pages:
            found.append(f"{source} has no page")
    for name in ("search/search_index.js", "search/lunr.js"):
        if not (folder / name).is_file():
            found.append(f"there is no {name}")
    return found + list(link_faults(folder, pages))


if __name__ == "__main__":
    errors = faults(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
    print("\n".join([*errors, f"{len(errors)} errors"]))
    sys.exit(1 if errors else 0)
