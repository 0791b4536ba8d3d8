"""Mutations: small faults that the tests must notice, listed in <module>.txt beside this file.

An entry names a function and a sequence of tokens in its body (white space and comments don't matter), not a line,
so it survives moves, reformatting and changes elsewhere in the function:

    [osc_error_limit] eleven errors per second are sent
    in ErrorRateLimit::allow
    - if (window->count >= kMaxPerSecond) return false;
    + if (window->count > kMaxPerSecond) return false;
    tests test_osc Sender.*

"in" names a function by its qualified name, without the namespace limber, or a file that is not C++ (such a mutation is
tried in a separate build). "-" and "+" may have several lines; without "+" the tokens are deleted. "tests" names a
test program, or another check of .ci/faults.sh ("tsan:test_base"), and a GoogleTest filter. A mutation counts as noticed
when the first of its tests fails.
"""
import dataclasses
import pathlib
import re

import cpp_source


class MutationError(Exception):
    """An invalid entry: file, line and reason."""


@dataclasses.dataclass
class Mutation:
    name: str
    fault: str
    place: str  # of the entry, for errors
    target: str = ""
    replace: str = ""
    by: str = ""
    tests: list = dataclasses.field(default_factory=list)  # of (program, filter)

    @property
    def alone(self):
        """True if it can't share a build with others."""
        return "." in self.target


def read(path):
    """The entries of one list."""
    found = []
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        place = f"{path}:{number}"
        if not line.strip() or line.startswith("#"):
            continue
        header = re.fullmatch(r"\[(\w+)\] (.+)", line)
        word, _, rest = line.partition(" ")
        if header:
            found.append(Mutation(header[1], header[2], place))
        elif not found:
            raise MutationError(f'{place}: expected "[name] fault", got "{line}"')
        elif word == "in":
            found[-1].target = rest
        elif word == "-":
            found[-1].replace += rest + "\n"
        elif word == "+":
            found[-1].by += rest + "\n"
        elif word == "tests":
            program, _, tests = rest.partition(" ")
            found[-1].tests.append((program, tests or "*"))
        else:
            raise MutationError(f'{place}: expected in, -, + or tests, got "{line}"')
    for entry in found:
        if not (entry.target and entry.replace and entry.tests):
            raise MutationError(f'{entry.place}: {entry.name} lacks "in", "-" or "tests"')
    return found


class Sources:
    """The C++ sources of a tree, and the functions in them by qualified name."""

    def __init__(self, texts):
        """texts: {path: text}"""
        self.text = texts
        self.tokens = {}
        self.functions = {}  # name: [(path, Function)]
        for path in sorted(texts):
            self.tokens[path] = cpp_source.tokens_of(texts[path])
            for function in cpp_source.functions_of(self.tokens[path]):
                self.functions.setdefault(function.name, []).append((path, function))

    def find(self, mutation):
        """(path, function, begin, end): where a mutation's tokens are, as offsets in the file's text."""
        wanted = [token.text for token in cpp_source.tokens_of(mutation.replace)]
        if mutation.target not in self.functions:
            raise MutationError(f"{mutation.place}: {mutation.name}: function {mutation.target} not found")
        hits = [
            (path, function, self.tokens[path][i].begin, self.tokens[path][i + len(wanted) - 1].end)
            for path, function in self.functions[mutation.target]
            for i in cpp_source.find_sequence(self.tokens[path], function.opening + 1, function.closing, wanted)
        ]
        if len(hits) != 1:
            raise MutationError(
                f"{mutation.place}: {mutation.name}: {mutation.target} contains these tokens {len(hits)} times"
                f"{': make them unique' if hits else ''}: {' '.join(wanted)}"
            )
        return hits[0]

    def mutated(self, mutation):
        """(path, function, body): the body of the function with the mutation, braces included."""
        path, function, begin, end = self.find(mutation)
        tokens, text = self.tokens[path], self.text[path]
        opening, closing = tokens[function.opening].begin, tokens[function.closing].end
        return path, function, text[opening:begin] + mutation.by + text[end:closing]


SWITCH = """#pragma once
#include <cstdlib>
#include <cstring>
/// True if the environment chooses this mutation.
inline bool limber_mutation(const char* name) {
  static const char* const chosen = std::getenv("LIMBER_MUTATION");
  return chosen != nullptr && std::strcmp(chosen, name) == 0;
}
"""


def condition(name):
    """A C++ expression that is true if the mutation is chosen; false in constant expressions."""
    call = f'[] {{ static const bool on = limber_mutation("{name}"); return on; }}()'
    return f"!__builtin_is_constant_evaluated() && {call}"


def plant(sources, mutations):
    """Gives each function with mutations a body for each of them, and returns {path: text}.

    All mutations are in one build: the environment variable LIMBER_MUTATION chooses one when the program runs.
    """
    bodies = {}  # (path, opening token): [(name, body)]
    for mutation in mutations:
        path, function, body = sources.mutated(mutation)
        bodies.setdefault((path, function.opening, function.closing), []).append((mutation.name, body))
    changed = {}
    for (path, opening, closing), variants in sorted(bodies.items(), reverse=True):
        text = changed.get(path, sources.text[path])
        begin, end = sources.tokens[path][opening].begin, sources.tokens[path][closing].end
        switch = "".join(
            f"if ({condition(name)}) {body} else "
            for name, body in variants
        )
        changed[path] = f"{text[:begin]}{{ {switch}{text[begin:end]} }}{text[end:]}"
    return changed
