"""Hook of mkdocs: adds files of the repository as pages, adapts Markdown, and writes the files of the search.

- Pages that link to CHANGELOG.md, the license and so on keep these links: the files are pages of the site (PROJECT).
- Python-Markdown, which mkdocs uses, is stricter than GitHub: the fence of a code block may only have a language, not
  the file name for the tests; lists and tables need an empty line before them.
- The search index is a script instead of JSON, which browsers load from a server only.
"""
import html
import json
import os
import pathlib
import posixpath
import re

from mkdocs.contrib import search
from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROJECT = {
    "CHANGELOG.md": "project/changelog.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "src/README.md": "project/sources.md",
    "SECURITY.md": "project/security.md",
    "LICENSE": "project/license.md",
}
FENCE = re.compile(r"^```(\w*).*$")
LIST = re.compile(r"^(- |[0-9]+\. )")
LINK = re.compile(r"(?<!!)\[([^\]\n]*(?:\n[^\]\n]*)?)\]\(([^)\s]+)\)")


def on_files(files, config):
    for page in PROJECT.values():
        files.append(File(page, config["docs_dir"], config["site_dir"], config["use_directory_urls"]))
    return files


def repository_path(page):
    """Path of a page's source in the repository."""
    source = page.file.src_path.replace(os.sep, "/")
    return {site: file for file, site in PROJECT.items()}.get(source, "docs/" + source)


def on_page_read_source(page, config):
    path = repository_path(page)
    if path.startswith("docs/"):
        return None
    text = (ROOT / path).read_text(encoding="utf-8")
    return text if path.endswith(".md") else "# License\n\n" + text


def adapt_links(markdown, path):
    """Redirects links to files that are pages of the site; links to other files of the repository become text."""
    here = posixpath.dirname(PROJECT.get(path, path.removeprefix("docs/")))

    def adapted(match):
        target, mark, anchor = match.group(2).partition("#")
        if not target or ":" in target:
            return match.group(0)
        file = posixpath.normpath(posixpath.join(posixpath.dirname(path), target))
        if file.startswith("docs/"):
            page = file.removeprefix("docs/")
        elif file in PROJECT:
            page = PROJECT[file]
        else:
            return match.group(1) if (ROOT / file).exists() else match.group(0)
        return f"[{match.group(1)}]({posixpath.relpath(page, here or '.')}{mark}{anchor})"

    return LINK.sub(adapted, markdown)


def adapt_blocks(markdown):
    lines, code, before = [], False, ""
    for line in markdown.split("\n"):
        fence = FENCE.match(line)
        if fence:
            if not code and before.strip():
                lines.append("")
            code = not code
            line = "```" + (fence.group(1) if code else "")
        elif not code and before.strip():
            begins_list = LIST.match(line) and not LIST.match(before) and not before.startswith(" ")
            if begins_list or (line.startswith("|") and not before.startswith("|")):
                lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines)


def on_page_markdown(markdown, page, **_):
    return adapt_blocks(adapt_links(markdown, repository_path(page)))


def on_post_build(config):
    folder = pathlib.Path(config["site_dir"], "search")
    index = json.loads((folder / "search_index.json").read_text(encoding="utf-8"))
    titles = {entry["location"]: entry["title"] for entry in index["docs"] if "#" not in entry["location"]}
    entries = [
        {
            "location": entry["location"],
            "page": titles[entry["location"].partition("#")[0]],
            "title": html.unescape(entry["title"]),
            "text": re.sub(r"\s+", " ", entry["text"]).strip(),
        }
        for entry in index["docs"]
        if "#" in entry["location"]
    ]
    text = json.dumps(entries, ensure_ascii=False, separators=(",", ":"))
    (folder / "search_index.js").write_text(f"const limberPages = {text};\n", encoding="utf-8")
    (folder / "search_index.json").unlink()
    lunr = pathlib.Path(search.base_path, "templates", "search", "lunr.js")
    (folder / "lunr.js").write_bytes(lunr.read_bytes())
