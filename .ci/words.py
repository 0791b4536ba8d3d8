#!/usr/bin/env python3
"""Checks the wording of comments, texts, documentation and names in the repository: standard terms instead of private ones.

Prints each finding as path:line, and ends with 1 if there are any. `.ci/words.py --share` prints the shares alone.
"""
import collections
import fnmatch
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "tests/mutations"))
import cpp_source  # noqa: E402

# phrases in comments, strings and documentation: pattern, replacement
PHRASES = [
    (r"\banew\b", "again"),
    (r"\bso many\b", "N, or the number of"),
    (r"\bat hand\b", "available"),
    (r"\b(?:is|was|are|were|be|been) told\b", "is reported, receives"),
    (r"\bcomes? to nothing\b", "has no effect"),
    (r"\bsomebody\b|\bnobody\b|\bwhoever\b|\bwhom\b", "the caller, the client, no listener"),
    (r"\b[Bb]ehaviour|\b[Nn]eighbour|\b[Cc]olour(?!ize)|\b[Cc]entre\b|\b[Cc]entred\b|\b[Ff]avour", "American spelling"),
    (r"\bseed'?s? (?:address|message)", "legacy address (ofxDabPhysics)"),
]
# "what" and "who" as nouns are allowed in at most this share of comment lines and of sentences of the documentation
CLAUSES = re.compile(r"\b(?:what|who|whose)\b", re.IGNORECASE)
MOST_CLAUSES = 0.01

# parts of identifiers in C++ and Lua: word, replacement
NAMES = {
    "anew": "again",
    "ailment": "instability",
    "effort": "work_budget",
    "grips": "mouse_springs",
    "hall": "hub",
    "hurry": "request",
    "irregular": "special",
    "keepsake": "saved_value",
    "lens": "camera",
    "newcomer": "added",
    "parted": "diverged",
    "posture": "body_state",
    "refusals": "unreachable",
    "room": "module, capacity",
    "roster": "body_list",
    "rouse": "wake",
    "said": "reported",
    "seldom": "throttle",
    "stance": "part_state",
    "told": "reported",
    "whips": "spin_clamp",
    "who": "source",
    "whom": "target",
}
# (path, text or word): reason
EXCEPTIONS = {
    ("CHANGELOG.md", "*"): "quotes what versions were called",
    (".ci/words.py", "*"): "lists the words",
    ("tests/golden/show.lua", "*"): "part of a recorded take, which contains its text",
    ("*", "effort"): "an attribute of URDF",
    ("*", "favour"): "favourites, a setting in the panel's file",
    ("scripts/quadruped.lua", "stance"): "a phase of a gait",
    ("tests/app/console_history_test.cpp", "somebody"): "a user's name",
    ("tests/app/gl_test.cpp", "nobody"): "the name of a display that does not exist",
    ("tests/environment/place.py", "nobody"): "a user's name",
}

TEXT_FILES = (".h", ".cpp", ".inc", ".lua", ".js", ".py", ".sh", ".vert", ".frag", ".glsl", ".md", ".tsv")
FOLDERS = ["src", "tests", "docs", "scripts", "behaviors_lua", "shaders", "urdf", ".ci", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "run", "check"]


def excepted(path, word):
    return any(fnmatch.fnmatch(path, p) and w in ("*", word) for p, w in EXCEPTIONS)


def cpp_texts(text):
    """(line, kind, text) of all comments and strings."""
    for match in cpp_source.TOKEN.finditer(text):
        if match.lastgroup in ("comment", "string", "delimiter") or match.group(0)[:1] in "\"R":
            kind = "comment" if match.group(0).startswith(("//", "/*")) else "string"
            line = text.count("\n", 0, match.start()) + 1
            for i, part in enumerate(match.group(0).split("\n")):
                yield line + i, kind, part


def script_texts(text, mark):
    for number, line in enumerate(text.split("\n"), 1):
        found = re.search(rf"(?:^|\s){mark}+\s*(.*)", line)
        if found:
            yield number, "comment", found.group(1)
        for string in re.findall(r'"(?:\\.|[^"\\])*"', line):
            yield number, "string", string


def page_texts(text):
    code = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            code = not code
        elif not code:
            yield number, "page", re.sub(r"`[^`]*`", "", line)


def texts_of(path, text):
    if path.endswith((".h", ".cpp", ".inc", ".js", ".vert", ".frag", ".glsl")):
        return cpp_texts(text)
    if path.endswith((".md", ".tsv")):
        return page_texts(text)
    return script_texts(text, "--" if path.endswith(".lua") else "#")


def names_of(path, text):
    """(line, identifier) in code."""
    if path.endswith((".h", ".cpp")):
        for token in cpp_source.tokens_of(text):
            if re.match(r"[A-Za-z_]\w*$", token.text):
                yield token.begin, token.text
    elif path.endswith(".lua"):
        code = re.sub(r"--[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", lambda m: " " * len(m.group(0)), text)
        for match in re.finditer(r"\b[A-Za-z_]\w*", code):
            yield match.start(), match.group(0)


def words_of(identifier):
    return [part.lower() for part in re.findall(r"[A-Z]?[a-z0-9]+|[A-Z]+(?![a-z])", identifier)]


def main():
    files = subprocess.run(["git", "ls-files", *FOLDERS], capture_output=True, text=True, check=True).stdout.split()
    findings, count, clauses = [], collections.Counter(), collections.defaultdict(list)
    for path in files:
        if not (path.endswith(TEXT_FILES) or path in ("run", "check")):
            continue
        text = pathlib.Path(path).read_text(errors="replace")
        for line, kind, part in texts_of(path, text):
            for pattern, instead in PHRASES:
                found = re.search(pattern, part)
                if found and not excepted(path, found.group(0)):
                    findings.append(f'{path}:{line}: "{found.group(0)}" ({instead}): {part.strip()[:100]}')
            group = "comments" if kind == "comment" else "sentences" if kind == "page" else None
            if group and part.strip():
                count[group] += 1 if kind == "comment" else max(len(re.findall(r"[.!?:](?:\s|$)", part)), 1)
                if CLAUSES.search(part) and not excepted(path, "what"):
                    clauses[group].append(f"{path}:{line}: {part.strip()[:100]}")
        for begin, identifier in names_of(path, text):
            for word in words_of(identifier):
                if word in NAMES and not excepted(path, word):
                    line = text.count("\n", 0, begin) + 1
                    findings.append(f"{path}:{line}: name {identifier} ({NAMES[word]})")
    for group, places in clauses.items():
        share = len(places) / count[group]
        print(f'{group} with "what" or "who" as a noun: {len(places)} of {count[group]} ({100 * share:.2f} %)')
        if share > MOST_CLAUSES:
            findings += places
    if "--share" not in sys.argv:
        print("\n".join(findings))
    print(f"{len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
