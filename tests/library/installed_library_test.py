#!/usr/bin/env python3
"""Installs the library of a build into a temporary folder, and builds projects outside of this one with it."""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
ARGUMENTS = None


def run(*command):
    """The output of a command; fails with it if the command does."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode == 0, f"{command}\n{done.stdout}"
    return done.stdout


class InstalledLibrary(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="fleetplan-library-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "prefix"
        run(ARGUMENTS.cmake, "--install", ARGUMENTS.build, "--component", "development", "--prefix", cls.prefix)

    def build(self, source, name):
        """Builds a project from a copy of its folder; returns the folder of the build."""
        copy, build = self.folder / name, self.folder / name / "build"
        shutil.copytree(source, copy)
        run(ARGUMENTS.cmake, "-G", "Ninja", "-S", copy, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={ARGUMENTS.compiler}")
        run(ARGUMENTS.cmake, "--build", build)
        return build

    def test_the_example_plans_without_collisions(self):
        output = run(self.build(PROJECT / "examples", "example") / "plan")
        self.assertRegex(output, r"(?s)\Aeast-bound arrives after .*flowtime \d+\.\d+ s, no collisions\n\Z")

    def test_the_program_of_the_document_runs(self):
        (program,) = re.findall(r"^```cpp\n(.*?)^```$", (PROJECT / "docs/library.md").read_text(), re.M | re.S)
        source = self.folder / "document.cpp"
        source.write_text(program)
        (archive,) = self.prefix.rglob("libfleetplan.a")
        run(ARGUMENTS.compiler, "-std=c++20", "-I", self.prefix / "include", source, archive,
            "-o", self.folder / "document")
        self.assertRegex(run(self.folder / "document"), r"(?m)s: to 3\.5, 2\.5\n\Z")

    def test_a_shared_library_may_contain_it(self):
        output = run(self.build(PROJECT / "tests/library/consumer", "consumer") / "consumer")
        self.assertEqual(output, f"{ARGUMENTS.version} verified, robots[0].radius\n")

    def test_every_header_compiles_alone_without_warnings(self):
        headers = sorted((self.prefix / "include/fleetplan").glob("*.h"))
        self.assertGreater(len(headers), 9)
        sources = []
        for header in headers:
            sources.append(self.folder / f"{header.stem}.cpp")
            sources[-1].write_text(f"#include <fleetplan/{header.name}>\n")
        run(ARGUMENTS.compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion",
            "-Werror", "-I", self.prefix / "include", *sources)

    def test_nothing_of_core_is_installed(self):
        installed = {str(path.relative_to(self.prefix)) for path in self.prefix.rglob("*.h")}
        self.assertEqual({name for name in installed if not name.startswith("include/fleetplan/")}, set())
        for config in self.prefix.rglob("*.cmake"):
            text = config.read_text()
            self.assertNotIn("Eigen", text)
            self.assertNotIn(str(PROJECT), text)

    def test_it_leaves_the_allocation_functions_alone(self):
        (archive,) = self.prefix.rglob("libfleetplan.a")
        symbols = run("nm", "--defined-only", archive)
        self.assertIn("fleetplan", symbols)
        self.assertNotRegex(symbols, r" [TW] _Zn[wa]m")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("cmake", "build", "compiler", "version"):
        parser.add_argument(f"--{name}", default="")
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=sys.argv[:1] + rest)
