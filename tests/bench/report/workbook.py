"""Reads the values of an XLSX workbook, which is an archive of XML files (ECMA-376, part 1)."""

import pathlib
import posixpath
import re
import xml.etree.ElementTree as ET
import zipfile

MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


def read_sheets(file):
    """The rows of each sheet by its name: {column: text} without empty cells; column A is 0."""
    with zipfile.ZipFile(pathlib.Path(file)) as book:
        strings = shared_strings(book)
        targets = {each.get("Id"): posixpath.join("xl", each.get("Target"))
                   for each in ET.fromstring(book.read("xl/_rels/workbook.xml.rels"))}
        sheets = ET.fromstring(book.read("xl/workbook.xml")).iter(MAIN + "sheet")
        return {sheet.get("name"): read_rows(book.read(targets[sheet.get(RELATION)]), strings) for sheet in sheets}


def shared_strings(book):
    if "xl/sharedStrings.xml" not in book.namelist():
        return []
    items = ET.fromstring(book.read("xl/sharedStrings.xml")).iter(MAIN + "si")
    return ["".join(text.text or "" for text in item.iter(MAIN + "t")) for item in items]


def read_rows(text, strings):
    return [dict(filter(None, (read_cell(cell, strings) for cell in row)))
            for row in ET.fromstring(text).iter(MAIN + "row")]


def read_cell(cell, strings):
    """The column and the text of a cell; None if it is empty."""
    value = cell.find(MAIN + "v")
    if value is None:
        return None
    return column_of(cell.get("r")), strings[int(value.text)] if cell.get("t") == "s" else value.text


def column_of(reference):
    """The number of the column in a reference such as AB12; column A is 0."""
    number = 0
    for letter in re.match("[A-Z]+", reference)[0]:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1
