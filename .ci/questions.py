#!/usr/bin/env python3
"""Checks docs/questions.md: at least thirty questions, each with a link to an existing page and heading that has text.

Prints each finding as page:line, and ends with 1 if there are any.
"""
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).parent.parent / "docs"
LEAST_QUESTIONS = 30
# an item of the list: the question, and below it the link to page and heading
QUESTION = re.compile(r"- (.+)$")
ANSWER = re.compile(r"  \[[^\]]+\]\(([^)#]+)#([^)]+)\)$")


def anchor_of(title):
    """The anchor of a heading, as mkdocs and GitHub make it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).lower()
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", text).strip())


def headings_of(page):
    """{anchor: True if text follows before the next heading of the same or a higher level}."""
    found, code, open_levels = {}, False, {}
    for line in page.read_text(encoding="utf-8").split("\n"):
        if line.startswith("```"):
            code = not code
        heading = None if code else re.match(r"(#+) (.*)", line)
        if heading:
            level = len(heading.group(1))
            open_levels = {anchor: at for anchor, at in open_levels.items() if at < level}
            anchor = anchor_of(heading.group(2))
            found[anchor] = False
            open_levels[anchor] = level
        elif line.strip():
            found.update({anchor: True for anchor in open_levels})
    return found


def findings(folder=DOCS):
    """Yields (line, text) of each fault."""
    questions, known = {}, {}
    lines = (folder / "questions.md").read_text(encoding="utf-8").split("\n")
    for number, (line, below) in enumerate(zip(lines, lines[1:]), 1):
        question = QUESTION.match(line)
        if not question:
            continue
        answer = ANSWER.match(below)
        if not answer:
            yield number, f"expected '  [page](page.md#heading)' below the question, got '{below}'"
            continue
        if question.group(1) in questions:
            yield number, f"'{question.group(1)}' is also in line {questions[question.group(1)]}"
        questions[question.group(1)] = number
        page, heading = answer.groups()
        path = folder / page
        if not path.is_file():
            yield number, f"page docs/{page} not found"
            continue
        headings = known.setdefault(page, headings_of(path))
        if heading not in headings:
            yield number, f"docs/{page} has no heading '{heading}'"
        elif not headings[heading]:
            yield number, f"docs/{page}: no text under the heading '{heading}'"
    if len(questions) < LEAST_QUESTIONS:
        yield 1, f"expected at least {LEAST_QUESTIONS} questions, got {len(questions)}"


def main():
    """Prints the findings; returns the exit code."""
    faults = list(findings())
    for line, text in faults:
        print(f"docs/questions.md:{line}: {text}")
    print(f"{len(faults)} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
