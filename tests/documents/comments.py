"""The comments of the sources: where they are, their sentences, and how many of these are hard to read.

Usage: comments.py prints the measures per folder and of the 40 files that are worst.
"""

import ast
import collections
import io
import os
import pathlib
import re
import tokenize

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
NOT_OURS = {"node_modules", "__pycache__", "build"}  # folders
FOLDERS = ("include", "core", "api", "library", "server", "web", "tests", "scripts", "clients")
PHRASES = re.compile(r"\b(one that|those that|that of|those of|none of them|another one)\b", re.IGNORECASE)
LONG = 30  # words; a longer sentence is long

# What may hide the beginning of a comment in C++ and JavaScript, and comments themselves. A slash begins a regular
# expression where no value can precede it.
_CPP = re.compile(r'R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)"' r"|\"(?:[^\"\\\n]|\\.)*\"|(?<![\w'])'(?:[^'\\\n]|\\.)+'"
                  r"|(?P<comment>//[^\n]*|/\*.*?\*/)", re.DOTALL)
_JS = re.compile(r"\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'|`(?:[^`\\]|\\.)*`|(?P<comment>//[^\n]*|/\*.*?\*/)"
                 r"|(?<=[(,=:\[!&|?{};\n])[ ]*/(?![/*])(?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/", re.DOTALL)
_SHELL = re.compile(r"(?P<comment>(?:^|(?<=\s))#(?!!)[^\n]*)|'[^']*'|\"(?:[^\"\\]|\\.)*\"|\\.", re.DOTALL | re.MULTILINE)

Comment = collections.namedtuple("Comment", "file line text")  # the line where it begins; without its markers


def sources():
    """The files with comments of the project, by their paths from its root."""
    found = []
    for root in FOLDERS:
        for folder, inner, files in os.walk(PROJECT / root):
            inner[:] = sorted(set(inner) - NOT_OURS)
            found += [(pathlib.Path(folder) / file).relative_to(PROJECT).as_posix() for file in sorted(files)]
    return [name for name in found if language(name)]


def language(name):
    suffix = pathlib.PurePath(name).suffix
    if suffix in (".h", ".cpp"):
        return "cpp"
    if suffix in (".js", ".mjs"):
        return "js"
    if suffix == ".py":
        return "python"
    if suffix == ".sh" or re.fullmatch(r"scripts/[\w-]+", name):
        return "shell"
    return None


def comments(name, text):
    """The comments of a file; lines of comment that follow each other are one comment."""
    kind = language(name)
    if kind == "python":
        found = sorted([*_python_comments(text), *_docstrings(text)])
    else:
        pattern = {"cpp": _CPP, "js": _JS, "shell": _SHELL}[kind]
        found = [_place(text, match.start("comment"), match.group("comment")) for match in pattern.finditer(text)
                 if match.group("comment") is not None]
    return [Comment(name, line, body) for line, body in _joined(found)]


def _place(text, begin, comment):
    """Line, column, whether it stands alone on its line, and the comment."""
    start = text.rfind("\n", 0, begin) + 1
    return text.count("\n", 0, begin) + 1, begin - start, text[start:begin].strip() == "", comment


def _python_comments(text):
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            yield token.start[0], token.start[1], token.line[:token.start[1]].strip() == "", token.string


def _docstrings(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            if ast.get_docstring(node) is not None:
                yield node.body[0].lineno, -1, True, '"""' + ast.get_docstring(node)


def _joined(found):
    """Lines and texts. A line comment goes on in the next line if that has one in the same column and no code."""
    result, end, column = [], None, None
    for line, start, alone, comment in found:
        body = _without_markers(comment)
        if body is None:
            continue
        one_line = comment.startswith(("//", "#"))
        if one_line and alone and (line, start) == (end, column):
            result[-1][1].append(body)
        else:
            result.append((line, [body]))
        end, column = (line + 1, start) if one_line else (None, None)
    return [(line, "\n".join(bodies)) for line, bodies in result]


def _without_markers(comment):
    """What a comment says; None for the name of a parameter and for orders to tools."""
    if comment.startswith("/*"):
        body = re.sub(r"^[ \t]*\*(?: |$)?", "", re.sub(r"^/\*\*? ?|\s*\*/$", "", comment), flags=re.MULTILINE)
        return None if re.fullmatch(r"[\w.]+ ?=?", body) else body
    body = re.sub(r"^(?:///?<? ?|#[:!]? ?|\"\"\")", "", comment)
    return None if re.match(r"NOLINT|clang-format|shellcheck|noqa|type: ignore|eslint|@ts-|pragma", body) else body


def sentences(comment):
    """The sentences of a comment. Paragraphs and items of lists end one; lines that are indented, such as
    pseudo-code and commands, are no sentences."""
    paragraphs, own = [[]], False
    for line in comment.text.split("\n"):
        item = re.match(r"\s*(?:[-*]|\d+\.|@\w+) +", line)
        if item:
            paragraphs.append([line[item.end():]])
            own = True
        elif not line.strip():
            paragraphs.append([])
            own = False
        elif re.match(r" {2,}", line) and not own:
            paragraphs.append([])
        else:
            paragraphs[-1].append(line)
    for lines in paragraphs:
        text = " ".join(" ".join(lines).split())
        text = re.sub(r"\b(e\.g|i\.e|cf|vs|etc|w\.r\.t)\.", r"\1", text)
        for sentence in re.split(r"(?<=[.!?])[)\"*]*\s+(?=[A-Z`0-9(*\"])", text):
            if re.search(r"[A-Za-z]{2}", sentence):
                yield sentence


def words(sentence):
    return sum(1 for word in sentence.split() if re.search(r"\w", word))


class Measure:
    """Of some comments: phrases, sentences, words, and the sentences that are long."""

    def __init__(self):
        self.phrases = self.sentences = self.words = self.long = 0

    def add(self, comment):
        self.phrases += len(PHRASES.findall(" ".join(comment.text.split())))
        for count in map(words, sentences(comment)):
            self.sentences += 1
            self.words += count
            self.long += count > LONG

    @property
    def mean(self):
        return self.words / max(1, self.sentences)

    @property
    def share(self):
        return self.long / max(1, self.sentences)

    def __str__(self):
        return (f"{self.phrases:4} phrases {self.sentences:6} sentences, mean {self.mean:5.1f} words, "
                f"{self.long:4} long = {100 * self.share:4.1f} %")


def measured(key):
    """Measures of the comments of all sources by a key of the name of their file, and one of all together."""
    measures, everything = collections.defaultdict(Measure), Measure()
    for name in sources():
        for comment in comments(name, (PROJECT / name).read_text()):
            measures[key(name)].add(comment)
            everything.add(comment)
    return measures, everything


def main():
    folders, everything = measured(folder)
    for name, measure in folders.items():
        print(f"{name:20} {measure}")
    print(f"{'all':20} {everything}")
    files, _ = measured(str)
    print()
    for name, measure in sorted(files.items(), key=lambda item: -(item[1].phrases + item[1].long))[:40]:
        print(f"{name:50} {measure}")


def folder(name):
    """The folder of a file; of core, the folder in it."""
    return "/".join(name.split("/")[:2 if name.startswith(("core/", "api/", "server/", "web/", "tests/")) else 1])


if __name__ == "__main__":
    main()
