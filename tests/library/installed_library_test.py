#!/usr/bin/env python3
"""Installs the library of a build into a temporary folder, and builds projects outside of this one with it."""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCUMENT = (PROJECT / "docs/library.md").read_text()
ARGUMENTS = None

# A project on a machine where libpng is not found.
WITHOUT_PNG = f"""
cmake_minimum_required(VERSION 3.25)
project(without_png LANGUAGES CXX)
set(CMAKE_DISABLE_FIND_PACKAGE_PNG TRUE)
find_package(fleetplan 0.1 REQUIRED)
add_executable(plan {PROJECT}/examples/plan.cpp)
target_link_libraries(plan PRIVATE fleetplan::planner)

find_package(fleetplan 0.1 COMPONENTS planner OPTIONAL_COMPONENTS service)
if(NOT fleetplan_FOUND OR NOT fleetplan_planner_FOUND OR fleetplan_service_FOUND OR TARGET fleetplan::service)
  message(FATAL_ERROR "an optional component is not optional")
endif()
foreach(component service other)
  find_package(fleetplan 0.1 QUIET COMPONENTS ${{component}})
  if(fleetplan_FOUND)
    message(FATAL_ERROR "${{component}} is found")
  endif()
endforeach()
"""


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
        copy = self.folder / name
        shutil.copytree(source, copy)
        return self.configured_and_built(copy)

    def configured_and_built(self, folder):
        """Builds the project of a folder; returns the folder of the build."""
        build = folder / "build"
        run(ARGUMENTS.cmake, "-G", "Ninja", "-S", folder, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={ARGUMENTS.compiler}")
        run(ARGUMENTS.cmake, "--build", build)
        return build

    def built_examples(self):
        """The folder of the build of the examples, which is made once."""
        build = self.folder / "examples" / "build"
        return build if build.exists() else self.build(PROJECT / "examples", "examples")

    def programs_of_the_document(self):
        return re.findall(r"^```cpp\n(.*?)^```$", DOCUMENT, re.M | re.S)

    def test_the_example_plans_without_collisions(self):
        output = run(self.built_examples() / "plan")
        self.assertRegex(output, r"(?s)\Aeast-bound arrives after .*flowtime \d+\.\d+ s, no collisions\n\Z")

    def test_the_example_keeps_a_fleet_running(self):
        lines = run(self.built_examples() / "fleet_loop").splitlines()
        self.assertEqual(lines[-1], "everybody has arrived")
        moments = [re.fullmatch(r" *(\d+\.0) s: \"solved\", (\d+\.\d\d) s to go", line) for line in lines[:-1]]
        self.assertGreater(len(moments), 3, lines)
        self.assertTrue(all(moments), lines)
        left = [float(moment.group(2)) for moment in moments]
        self.assertEqual(left[-1], 0.0)
        self.assertTrue(any(later > earlier for earlier, later in zip(left, left[1:])), "nothing is new on the way")

    def test_the_program_of_the_document_runs(self):
        program, _ = self.programs_of_the_document()
        source = self.folder / "document.cpp"
        source.write_text(program)
        (archive,) = self.prefix.rglob("libfleetplan.a")
        run(ARGUMENTS.compiler, "-std=c++20", "-I", self.prefix / "include", source, archive,
            "-o", self.folder / "document")
        self.assertRegex(run(self.folder / "document"), r"(?m)s: to 3\.5, 2\.5\n\Z")

    def test_the_program_of_the_document_answers_what_the_service_answers(self):
        _, program = self.programs_of_the_document()
        (project,) = re.findall(r"^```cmake\n(find_package\([^\n]* service\)\n.*?)^```$", DOCUMENT, re.M | re.S)
        folder = self.folder / "service"
        folder.mkdir()
        (folder / "program.cpp").write_text(program)
        (folder / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(answers LANGUAGES CXX)\n"
                                               f"add_executable(my_program program.cpp)\n{project}")
        plan = json.loads(run(self.configured_and_built(folder) / "my_program"))
        self.assertEqual(plan["status"], "solved")
        self.assertEqual([visit["goal"] for robot in plan["plans"] for visit in robot["visits"]], [0, 0])

    def test_programs_that_only_plan_need_no_libpng(self):
        folder = self.folder / "without_png"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(WITHOUT_PNG)
        self.assertNotIn("libpng", run("ldd", self.configured_and_built(folder) / "plan"))

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
        for name in ("libfleetplan.a", "libfleetplan_service.a"):
            (archive,) = self.prefix.rglob(name)
            symbols = run("nm", "--defined-only", archive)
            self.assertIn("fleetplan", symbols)
            self.assertNotRegex(symbols, r" [TW] _Zn[wa]m")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("cmake", "build", "compiler", "version"):
        parser.add_argument(f"--{name}", default="")
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=sys.argv[:1] + rest)
