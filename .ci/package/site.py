"""Adapts the pages for Python-Markdown, which mkdocs uses and which is stricter than GitHub.

- The fence of a code block may only have a language, not the file name for the tests.
- Lists and tables need an empty line before them.
"""
import re

FENCE = re.compile(r"^```(\w*).*$")
LIST = re.compile(r"^(- |[0-9]+\. )")


def on_page_markdown(markdown, **_):
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
