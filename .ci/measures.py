#!/usr/bin/env python3
"""Prints measures of the sources' structure: folders, classes, complexity, friends, lines, wording.

    .ci/measures.py            all but the cost of a rebuild
    .ci/measures.py --check  fails if one of them exceeds its limit (LIMITS)
    .ci/measures.py --rebuild src/sim/world/motor.h
                               processor seconds that a change of this header costs in a debug build (a full build first)
"""
import collections
import os
import pathlib
import re
import resource
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "tests/mutations"))
import cpp_source  # noqa: E402

BRANCHES = {"if", "for", "while", "case", "catch", "&&", "||", "?"}


def sources():
    names = subprocess.run(["git", "ls-files", "src"], capture_output=True, text=True, check=True).stdout.split()
    return {name: pathlib.Path(name).read_text() for name in names if name.endswith((".h", ".cpp", ".inc"))}


def classes_of(tokens):
    """(name, functions, fields) of each class; overloads count one each."""
    found = []
    stack = []  # of [kind, name, functions, fields], for each open brace
    begin = 0
    for i, token in enumerate(tokens):
        text = token.text
        inside = stack[-1] if stack else None
        if text == "{":
            head = [t.text for t in tokens[begin:i]]
            kind = "block"
            name = ""
            if "(" not in head and "enum" not in head and ("class" in head or "struct" in head):
                at = max(j for j, w in enumerate(head) if w in ("class", "struct"))
                kind, name = "class", head[at + 1] if at + 1 < len(head) else ""
            elif "namespace" in head:
                kind = "namespace"
            elif inside and inside[0] == "class":
                kind = "function" if "(" in head and "=" not in head[: head.index("(")] else "initializer"
                if kind == "function":
                    inside[2] += 1
            stack.append([kind, name, 0, 0])
            begin = i + 1
        elif text == "}":
            closed = stack.pop() if stack else None
            if closed and closed[0] == "class":
                found.append(tuple(closed[1:]))
            if not closed or closed[0] != "initializer":
                begin = i + 1
        elif text == ";":
            head = [t.text for t in tokens[begin:i]]
            if inside and inside[0] == "class" and head and head[0] not in ("using", "friend", "static_assert", "enum"):
                declares = "(" in head and (head.index("(") == 0 or head[head.index("(") - 1] not in ("decltype", "alignas"))
                before = head[: head.index("(")] if declares else head
                if declares and "=" not in before and "{" not in before and "<" not in before[-1:]:
                    if head[-2:] not in (["=", "delete"],):
                        inside[2] += 1
                elif "static" not in head and head not in (["class"], ["struct"]) and len(head) > 1 and head[0] not in ("class", "struct"):
                    inside[3] += 1
            begin = i + 1
        elif text == ":" and i and tokens[i - 1].text in ("public", "private", "protected"):
            begin = i + 1
    return found


# The largest permitted values, which --check enforces.
LIMITS = {"files in a folder": 30, "functions of a class": 45, "fields of a class": 20, "cyclomatic complexity": 15,
          "friend declarations": 8}

# Classes and functions above a limit, with their present values: each change may lower them only.
EXCEPTIONS = {
}


def measure():
    """Returns the lines of src, and for each of LIMITS the values with their places, largest first."""
    texts = sources()
    values = {name: [] for name in LIMITS}
    friends = 0
    for name, text in texts.items():
        tokens = cpp_source.tokens_of(text)
        friends += sum(token.text == "friend" for token in tokens)
        for title, functions, fields in classes_of(tokens):
            values["functions of a class"].append((functions, f"{title} ({name})"))
            values["fields of a class"].append((fields, f"{title} ({name})"))
        for function in cpp_source.functions_of(tokens):
            branches = sum(token.text in BRANCHES for token in tokens[function.opening : function.closing])
            values["cyclomatic complexity"].append((1 + branches, f"{function.name} ({name})"))
    for folder, files in collections.Counter(os.path.dirname(name) for name in texts).items():
        values["files in a folder"].append((files, folder))
    values["friend declarations"].append((friends, "src"))
    return sum(text.count("\n") for text in texts.values()), {k: sorted(v, reverse=True) for k, v in values.items()}


def report():
    lines, values = measure()
    print(f"lines in src: {lines}")
    for name, found in values.items():
        for value, place in found[:5]:
            print(f"{name}: {value}, {place}" + (" (too many)" if value > LIMITS[name] else ""))
    subprocess.run([sys.executable, pathlib.Path(__file__).parent / "words.py", "--share"], check=False)


def check():
    too_many = [f"{place}: {value} {name}, at most {LIMITS[name]} are allowed"
                for name, found in measure()[1].items() for value, place in found
                if value > max(LIMITS[name], EXCEPTIONS.get(name, {}).get(place.split(" ")[0], 0))]
    print("\n".join(too_many) or "all measures are within their limits")
    return 1 if too_many else 0


def rebuild(header):
    folder = "build/debug_measure"
    subprocess.run(["cmake", "--preset", "debug", "-B", folder, "-DLIMBER_UNITY=OFF", "-DLIMBER_TESTS=OFF",
                    "-DCMAKE_CXX_COMPILER_LAUNCHER="], check=True, stdout=subprocess.DEVNULL)
    build = ["cmake", "--build", folder]
    subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
    os.utime(header)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{header}: {after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime:.0f} s")


if __name__ == "__main__":
    if "--rebuild" in sys.argv:
        rebuild(sys.argv[sys.argv.index("--rebuild") + 1])
    elif "--check" in sys.argv:
        sys.exit(check())
    else:
        report()
