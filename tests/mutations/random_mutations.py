#!/usr/bin/env python3
"""Makes random mutations in a module, runs its tests with each of them, and lists those that survive.

A survivor is a missing test, or code without effect (a reservation, a prefetch, an equivalent formula).
Run in the repository's root, for example: tests/mutations/random_mutations.py osc --count 60 --seed 2
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys
import time

import cpp_source
import mutations
import plant

SWAPS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
    "+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "true": "false", "false": "true",
}
NO_STATEMENT = "return if for while switch case default const constexpr auto static using break continue do else throw delete struct".split()


def is_spaced(text, token):
    """True for a binary operator; template brackets, references and signs have no space on one side."""
    return text[token.begin - 1].isspace() and text[token.end].isspace()


def statement_end(tokens, first, last):
    """The index of the ";" that ends an expression statement at first; None if that is another kind of statement."""
    if tokens[first].text in NO_STATEMENT or not re.match(r"\w|\*|\(|\+\+|--", tokens[first].text):
        return None
    depth = 0
    for i in range(first, last):
        text = tokens[i].text
        if text == "{" and depth == 0:
            return None
        depth += (text in "([{") - (text in ")]}")
        if depth < 0:
            return None
        if depth == 0 and i > first and re.match(r"\w", text) and re.match(r"[\w>]", tokens[i - 1].text):
            return None  # a declaration: two words in a row
        if text == ";" and depth == 0:
            return i
    return None


def changes_of(text, tokens, function):
    """All mutations of a function, as (begin, end, replacement, description) with offsets in the text."""
    for i in range(function.opening + 1, function.closing):
        token = tokens[i]
        if token.text in SWAPS and (token.text in ("true", "false") or is_spaced(text, token)):
            yield token.begin, token.end, SWAPS[token.text], f"{token.text} becomes {SWAPS[token.text]}"
        elif re.fullmatch(r"\d+", token.text):
            changed = str(int(token.text) + 1)
            yield token.begin, token.end, changed, f"{token.text} becomes {changed}"
        elif re.fullmatch(r"\d*\.\d+|\d+e-?\d+|\d*\.\d+e-?\d+", token.text):
            yield token.begin, token.end, f"(2 * {token.text})", f"{token.text} is doubled"
        elif token.text == "if" and tokens[i + 1].text == "(":
            closing = cpp_source.matching(tokens, i + 1, "(", ")")
            inner = text[tokens[i + 1].end : tokens[closing].begin]
            if ";" not in inner and not re.match(r"\s*(const|auto)\b", inner):
                yield tokens[i + 1].end, tokens[closing].begin, f"!({inner})", f"if ({' '.join(inner.split())}) is negated"
        if tokens[i - 1].text in (";", "{", "}"):
            end = statement_end(tokens, i, function.closing)
            if end is not None:
                removed = " ".join(text[token.begin : tokens[end].end].split())
                yield token.begin, tokens[end].begin, "", f"deleted: {removed}"


class Planted:
    """Random mutations in a copy of the last commit, without those that don't compile."""

    def __init__(self, module, count, seed, folder):
        self.folder = folder
        self.files = plant.committed_files()
        pattern = re.escape(module) if "." in module else rf"src/{module}/.*\.(cpp|h)"
        texts = {name: content.decode() for name, (content, _) in self.files.items() if re.fullmatch(pattern, name)}
        sources = mutations.Sources(texts)
        places = []
        for functions in sources.functions.values():
            for path, function in functions:
                places += [(path, function, c) for c in changes_of(texts[path], sources.tokens[path], function)]
        self.sources = sources
        self.chosen = dict(enumerate(random.Random(seed).sample(places, min(count, len(places)))))

    def describe(self, number):
        path, function, change = self.chosen[number]
        line = self.sources.text[path].count("\n", 0, change[0]) + 1
        return f"{path}:{line}: {function.name}: {change[3]}"

    def plant(self):
        """Writes the copy, and returns {path: [(first line, last line, number)]} of the mutated bodies."""
        files = dict(self.files)
        files[plant.SWITCH_HEADER] = (mutations.SWITCH.encode(), 0o644)
        by_function = {}
        for number, (path, function, change) in self.chosen.items():
            by_function.setdefault((path, function), []).append((number, change))
        inserted = {}  # path: [(offset, text, number or None)]
        for (path, function), variants in by_function.items():
            text, tokens = self.sources.text[path], self.sources.tokens[path]
            opening, closing = tokens[function.opening].begin, tokens[function.closing].end
            pieces = inserted.setdefault(path, [])
            pieces.append((opening, "{ ", None))
            for number, (begin, end, by, _) in variants:
                body = text[opening:begin] + by + text[end:closing]
                condition = mutations.condition(f"random_{number}")
                pieces.append((opening, f"if ({condition}) {body}\nelse ", number))
            pieces.append((closing, " }", None))
        ranges = {}
        for path, pieces in inserted.items():
            out, last, text = '#include "base/mutation_switch.h"\n', 0, self.sources.text[path]
            for offset, piece, number in sorted(pieces, key=lambda p: p[0]):
                out += text[last:offset]
                last = offset
                first = out.count("\n") + 1
                out += piece
                if number is not None:
                    ranges.setdefault(path, []).append((first, out.count("\n"), number))
            files[path] = ((out + text[last:]).encode(), self.files[path][1])
        plant.synchronize(self.folder, files)
        return ranges

    def build(self, programs, jobs):
        """Builds with all mutations, and drops those that don't compile."""
        build = self.folder / "build/plain"
        if not (build / "build.ninja").exists():
            subprocess.run(["cmake", "-S", self.folder, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Sanitize",
                            "-DLIMBER_TESTS=ON", "-DLIMBER_UNITY=ON"], check=True, stdout=subprocess.DEVNULL)
        for _ in range(6):
            ranges = self.plant()
            run = subprocess.run(["cmake", "--build", build, "-j", str(jobs), "--target", *programs, "--", "-k", "0"],
                                 capture_output=True, text=True)
            if run.returncode == 0:
                return
            dropped = set()
            for path, line in re.findall(r"([\w/.]+\.(?:cpp|h)):(\d+):\d+: (?:fatal )?error", run.stdout):
                for mutated, places in ranges.items():
                    if path.endswith(mutated):
                        dropped |= {number for first, last, number in places if first <= int(line) <= last}
            if not dropped:
                sys.exit(f"random_mutations.py: the build fails\n{run.stdout[-4000:]}")
            for number in dropped:
                self.chosen.pop(number, None)
        sys.exit("random_mutations.py: the build fails again and again")


def run_tests(planted, programs, name, seconds):
    """Returns True if all tests pass."""
    environment = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "HOME": "/nonexistent", "LC_ALL": "C.UTF-8", "LIMBER_MUTATION": name}
    for program in programs:
        try:
            run = subprocess.run([planted.folder / "build/plain" / program, "--gtest_fail_fast", "--gtest_brief=1"],
                                 env=environment, capture_output=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return False
        if run.returncode != 0:
            return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("module", help="a folder of src/, or one file as src/...")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tests", help="test programs, separated by commas; default: the module's")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("build/faults/random"))
    parser.add_argument("--jobs", type=int, default=2, help="parallel jobs of the build")
    options = parser.parse_args()
    name = options.module.split("/")[1] if options.module.startswith("src/") else options.module.split("/")[0]
    programs = options.tests.split(",") if options.tests else [f"test_{name}"]
    planted = Planted(options.module, options.count, options.seed, options.folder)
    planted.build(programs, options.jobs)
    begin = time.monotonic()
    if not run_tests(planted, programs, "", 1200):
        sys.exit("random_mutations.py: the tests fail without a mutation")
    seconds = 30 + 10 * (time.monotonic() - begin)
    survivors = [n for n in sorted(planted.chosen) if run_tests(planted, programs, f"random_{n}", seconds)]
    for number in survivors:
        print(planted.describe(number))
    print(f"{len(survivors)} of {len(planted.chosen)} mutations survived")


if __name__ == "__main__":
    main()
