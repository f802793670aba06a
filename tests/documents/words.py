#!/usr/bin/env python3
"""How easily the documents are read: phrases that point back, and long sentences, page by page.

Usage: words.py [PAGE ...]
Without arguments, prints a table of all pages; with pages, prints their long sentences and phrases.
"""

import pathlib
import re
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
PHRASE = re.compile(r"\b(one that|those that|that of|those of|none of them|another one)\b", re.IGNORECASE)
LONG = 30  # words; a longer sentence is hard to read
CELL = 4  # words; a shorter cell of a table is a name or a number and not a sentence
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|cf|vs|et al)\.")
END = re.compile(r"(?<=[.!?])[*_)\"]*\s+(?=[A-Z`\"*_(\[0-9])|<br>")


def pages():
    """The documents by their names."""
    return {str(path.relative_to(PROJECT)): path.read_text()
            for path in sorted([*PROJECT.glob("*.md"), *PROJECT.glob("docs/*.md")])}


def blocks(text):
    """The paragraphs, items of lists and cells of tables, each with whether it is a cell. No code blocks, no headings."""
    text = re.sub(r"^ *```.*?^ *```$", "\n", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"<?https?://\S+", "URL", text)
    lines = []
    for line in [*map(str.strip, text.splitlines()), ""]:
        item = re.match(r"([-*]|\d+\.) ", line)
        if (item or not line or line[0] in "#|") and lines:
            yield " ".join(lines), False
            lines = []
        if line.startswith("|"):
            yield from ((cell.strip(), True) for cell in re.split(r"(?<!\\)\|", line.strip("|")))
        elif line and not line.startswith("#"):
            lines.append(line[item.end():] if item else line)


def sentences(text):
    """Each sentence with its number of words; what is in backticks is one word."""
    for block, cell in blocks(text):
        block = re.sub(r"<(?!br>)[^>]+>", "", re.sub(r"`[^`]*`", "`code`", block))
        block = ABBREVIATION.sub(lambda found: found.group().replace(".", ""), block)
        for sentence in END.split(block):
            words = sum(bool(re.search(r"\w", word)) for word in sentence.split())
            if words >= (CELL if cell else 1):
                yield words, sentence


def phrases(text):
    """Each phrase with the words around it."""
    return [block[max(0, found.start() - 60):found.end() + 40]
            for block, _ in blocks(text) for found in PHRASE.finditer(block)]


def measure(text):
    """Number of phrases, number of sentences, mean words a sentence, share of long sentences."""
    words = [count for count, _ in sentences(text)]
    number = max(1, len(words))
    return len(phrases(text)), len(words), sum(words) / number, sum(count > LONG for count in words) / number


def table():
    rows = {name: measure(text) for name, text in pages().items()}
    lines = [f"{'page':28} phrases sentences  mean  long"]
    lines += [f"{name:28} {found:7} {number:9} {mean:5.1f} {100 * share:4.0f} %"
              for name, (found, number, mean, share) in rows.items()]
    return "\n".join([*lines, f"{'all':28} {sum(row[0] for row in rows.values()):7}"])


if __name__ == "__main__":
    if len(sys.argv) == 1:
        print(table())
    for page in sys.argv[1:]:
        content = pathlib.Path(page).read_text()
        for count, sentence in sentences(content):
            if count > LONG:
                print(f"{page}: {count} words: {sentence}")
        for phrase in phrases(content):
            print(f"{page}: phrase: {phrase}")
