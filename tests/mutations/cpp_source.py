"""Finds the functions of a C++ source file, and a sequence of tokens in them.

It is not a C++ parser: it expects code formatted by clang-format, and does not run the preprocessor.
"""
import re
from typing import NamedTuple

TOKEN = re.compile(
    r"""(?P<space>\s+)
      | (?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<directive>^[ \t]*\#(?:\\\n|[^\n])*)
      | (?P<string>(?:u8|[uUL])?R"(?P<delimiter>[^()\s\\]*)\(.*?\)(?P=delimiter)"
                  |(?:u8|[uUL])?"(?:\\.|[^"\\\n])*"|[uUL]?'(?:\\.|[^'\\\n])*')
      | (?P<number>\.?\d(?:[eEpP][+-]|'?[\w.])*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<mark><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|<<|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)""",
    re.VERBOSE | re.DOTALL | re.MULTILINE,
)


class Token(NamedTuple):
    text: str
    begin: int  # offset of the first character in the file
    end: int


class Function(NamedTuple):
    name: str  # qualified, without the namespace limber
    head: int  # index of the first token of the declaration
    opening: int  # index of the token "{" of the body
    closing: int  # index of the matching "}"


def tokens_of(text):
    """All tokens of a text but white space, comments and preprocessor directives."""
    return [
        Token(match.group(0), match.start(), match.end())
        for match in TOKEN.finditer(text)
        if match.lastgroup not in ("space", "comment", "directive")
    ]


def matching(tokens, index, opening="{", closing="}"):
    """The index of the token that closes the bracket at index."""
    depth = 0
    for i in range(index, len(tokens)):
        depth += (tokens[i].text == opening) - (tokens[i].text == closing)
        if depth == 0:
            return i
    raise ValueError(f"unbalanced {opening} at offset {tokens[index].begin}")


def _declarator_name(head):
    """The qualified name before the first parenthesis outside of brackets; None if there is none."""
    depth = 0
    for i, token in enumerate(head):
        if token == "(" and depth == 0 and i > 0 and head[i - 1] not in ("decltype", "alignas", "noexcept", "requires"):
            if head[i - 1] == "operator":  # operator()
                i += 2
            break
        if token in "([" or (token == "<" and i > 0 and head[i - 1] != "operator"):
            depth += 1
        if token in ")]" or (token == ">" and depth > 0):
            depth -= 1
        if token == "=" and depth == 0 and head[i - 1] != "operator":
            return None  # a variable with an initializer
    else:
        return None
    name = []
    i -= 1
    if "operator" in head[max(i - 3, 0) : i + 1]:
        start = max(j for j in range(max(i - 3, 0), i + 1) if head[j] == "operator")
        name = ["".join(head[start : i + 1])]
        i = start - 1
        if i < 0 or head[i] != "::":
            return "".join(name)
    while i >= 0:
        if head[i] == ">":  # template arguments of a class
            depth = 0
            while i >= 0:
                depth += (head[i] == ">") - (head[i] == "<")
                i -= 1
                if depth == 0:
                    break
            continue
        if re.fullmatch(r"\w+", head[i]) and (not name or name[0] in ("::", "~")):
            name.insert(0, head[i])
        elif head[i] in ("::", "~") and name and name[0] not in ("::", "~"):
            name.insert(0, head[i])
        else:
            break
        i -= 1
    text = "".join(name)
    return text if text and not text.startswith("::") else None


def _is_member_initializer(head):
    """True if "{" after these tokens initializes a member in a constructor's list, as in ": a_{1}"."""
    depth = 0
    colon = False
    for i, token in enumerate(head):
        depth += (token in "([") - (token in ")]")
        if token == ":" and depth == 0 and i > 0 and head[i - 1] in (")", "noexcept"):
            colon = True
    return colon and re.fullmatch(r"\w+|>", head[-1]) is not None


# The namespaces of the modules are not part of a function's name.
NAMESPACES = re.compile(r"^limber::(sim::(bullet|collision|solver)::|(model|sim|script|engine|osc|oscquery|lighting|console|panel|render|exporter|experiments|app)::)?")


def functions_of(tokens):
    """All functions with a body, in the file's order. Lambdas belong to the function that they are in."""
    found = []
    scopes = []  # names of namespaces and classes; None closes nothing
    begin = 0  # index of the first token of the current declaration
    i = 0
    while i < len(tokens):
        text = tokens[i].text
        if text == ";":
            begin = i + 1
        elif text == ":" and i > 0 and tokens[i - 1].text in ("public", "private", "protected"):
            begin = i + 1
        elif text == "}":
            if scopes:
                scopes.pop()
            begin = i + 1
        elif text == "{":
            head = [token.text for token in tokens[begin:i]]
            while head and head[0] == "template":
                depth = 0
                for j, word in enumerate(head):
                    depth += (word == "<") - (word == ">")
                    if j > 0 and depth == 0:
                        break
                head = head[j + 1 :]
            if "namespace" in head or (head and head[0] == "extern" and "(" not in head):
                name = "".join(head[head.index("namespace") + 1 :]) if "namespace" in head else ""
                scopes.append(name)
                begin = i + 1
            elif "enum" not in head and "(" not in head and any(word in head for word in ("class", "struct", "union")):
                at = next(j for j, word in enumerate(head) if word in ("class", "struct", "union"))
                words = [w for w in head[at + 1 :] if w not in ("[", "]", "nodiscard")]
                end = next((j for j, w in enumerate(words) if not re.fullmatch(r"\w+|::", w) or w == "final"), len(words))
                scopes.append("".join(words[:end]))
                begin = i + 1
            else:
                closing = matching(tokens, i)
                name = _declarator_name(head)
                if name is not None and _is_member_initializer(head):
                    i = closing  # the declaration continues
                elif name is not None:
                    parts = [scope for scope in scopes if scope] + [name]
                    found.append(Function(NAMESPACES.sub("", "::".join(parts)), begin, i, closing))
                    i = closing
                    begin = i + 1
                else:
                    i = closing  # an initializer or an enumeration
        i += 1
    return found


def find_sequence(tokens, first, last, wanted):
    """Indices at which the texts `wanted` begin within tokens[first:last]."""
    size = len(wanted)
    return [
        i
        for i in range(first, last - size + 1)
        if all(tokens[i + j].text == wanted[j] for j in range(size))
    ]
