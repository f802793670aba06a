"""The package: its types, the wheel, an installation without a network, and the examples of docs/python.md."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

from support import PACKAGE, PROJECT, service

DOCUMENT = (PROJECT / "docs/python.md").read_text()
SERVICE = "http://localhost:8080"  # as the document writes it


def run(*command, **how):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, **how)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def copied(folder):
    """The package's sources, in a place where builds may leave files."""
    return shutil.copytree(PACKAGE, pathlib.Path(folder) / "python",
                           ignore=shutil.ignore_patterns("build", "dist", "*.egg-info", "__pycache__", ".mypy_cache"))


class Package(unittest.TestCase):
    def test_its_types_are_sound(self):
        with tempfile.TemporaryDirectory() as cache:
            run(sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, PACKAGE / "fleetplan")

    def test_a_wheel_has_the_modules_and_the_marker_of_types(self):
        with tempfile.TemporaryDirectory() as folder:
            run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, copied(folder))
            (wheel,) = pathlib.Path(folder).glob("fleetplan-*.whl")
            names = {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith("fleetplan/")}
        self.assertEqual(names, {f"fleetplan/{path.name}" for path in (PACKAGE / "fleetplan").iterdir() if path.is_file()})
        self.assertIn("fleetplan/py.typed", names)

    def test_it_is_installed_without_a_network_and_needs_nothing_else(self):
        with tempfile.TemporaryDirectory() as folder:
            run(sys.executable, "-m", "pip", "install", "--no-index", "--no-build-isolation", "--disable-pip-version-check",
                "--root-user-action=ignore", "--target", pathlib.Path(folder) / "installed", copied(folder))
            printed = run(sys.executable, "-S", "-c", "import fleetplan; print(fleetplan.__file__)",
                          cwd=pathlib.Path(folder) / "installed")
        self.assertIn("installed/fleetplan/__init__.py", printed)

    def test_its_version_is_that_of_the_build(self):
        (version,) = re.findall(r"^project\(fleetplan VERSION (\S+)", (PROJECT / "CMakeLists.txt").read_text(), re.MULTILINE)
        self.assertEqual(re.findall(r'^version = "(.*)"', (PACKAGE / "pyproject.toml").read_text(), re.MULTILINE), [version])


class Document(unittest.TestCase):
    def examples(self):
        return [block for block in re.findall(r"^```python\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
                if SERVICE in block]

    def run_example(self, example):
        with service() as url:
            return run(sys.executable, "-B", "-c", example.replace(SERVICE, url), cwd=PACKAGE)

    def test_the_loop_serves_robots_and_is_short(self):
        loop, _ = self.examples()
        lines = [line for line in loop.splitlines() if line and not line.startswith(("from ", "import "))]
        self.assertLessEqual(len(lines), 11)
        self.assertGreater(self.run_example(loop).count("has arrived"), 10)

    def test_the_events_are_printed(self):
        _, events = self.examples()
        self.assertRegex(self.run_example(events), r"of 8 robots are planned\n(.*\n)*solved \d+")

    def test_the_methods_and_members_that_it_names_exist(self):
        sources = "\n".join(path.read_text() for path in (PACKAGE / "fleetplan").glob("*.py"))
        for name in re.findall(r"`([A-Za-z_][A-Za-z_.]*)(?:\([^`]*\))?`", DOCUMENT):
            for word in name.split("."):
                self.assertRegex(sources, rf"\b{word}\b", name)


if __name__ == "__main__":
    unittest.main()
