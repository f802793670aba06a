#!/usr/bin/env python3
"""Runs the examples of the documents against a server of this build, and compares their tables with it.

Usage: documents_test.py FLEETPLAN_BINARY [unittest arguments]
The shell examples need curl and jq; without them they are skipped.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.error
import urllib.request

import words

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCUMENTS = {str(path.relative_to(PROJECT)): path.read_text()
             for path in [*PROJECT.glob("*.md"), *PROJECT.glob("docs/*.md")]}
BINARY = None
SERVICE = "http://localhost:8080"  # as the documents write it


def blocks(document, language):
    """The code blocks of a document in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", DOCUMENTS[document], re.MULTILINE | re.DOTALL)


def table(document, header):
    """The rows of the table whose first row begins with these cells, as lists of cells without the header."""
    lines = DOCUMENTS[document].splitlines()
    begin = next((i for i, line in enumerate(lines) if cells(line)[:len(header)] == header), None)
    assert begin is not None, f"{document} has no table with the columns {header}"
    rows = []
    for line in lines[begin + 2:]:
        if not line.startswith("|"):
            break
        rows.append(cells(line))
    return rows


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []


def code(cell):
    """What a cell has in backticks."""
    return re.findall(r"`([^`]+)`", cell)


def anchor(heading):
    """The anchor that GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def first_request():
    """The first request of the page of requests; the page of responses has its answer."""
    return json.loads(blocks("docs/plan_request.md", "json")[0])


def first_response():
    return json.loads(blocks("docs/plan_response.md", "json")[0])


def prose(text):
    """A document without its code blocks."""
    return re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)


def values(node, key):
    """All values of a key anywhere in a JSON document."""
    if isinstance(node, dict):
        for name, value in node.items():
            if name == key:
                yield value
            yield from values(value, key)
    elif isinstance(node, list):
        for value in node:
            yield from values(value, key)


class DocumentTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen([BINARY, "--port", "0", "--log-level", "off"],
                                      stdout=subprocess.PIPE, text=True)
        line = cls.server.stdout.readline()
        cls.url = re.search(r"http://\S+", line).group()
        cls.openapi = json.loads(cls.get("/v1/openapi.json"))

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.server.stdout.close()

    @classmethod
    def get(cls, path):
        with urllib.request.urlopen(cls.url + path) as response:
            return response.read().decode()

    def post(self, path, body):
        request = urllib.request.Request(self.url + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request) as response:
            return json.load(response)

    def schema(self, name):
        return self.openapi["components"]["schemas"][name]

    def resolve(self, node):
        """A schema with what it refers to; its own members have precedence."""
        if "$ref" not in node:
            return node
        target = self.openapi
        for name in node["$ref"].removeprefix("#/").split("/"):
            target = target[name]
        return {**self.resolve(target), **node}

    def assert_shape(self, shown, answer, where="answer"):
        """The answer has at least the members that are shown, of the same types."""
        if isinstance(shown, dict):
            self.assertLessEqual(set(shown), set(answer), where)
            for key, value in shown.items():
                self.assert_shape(value, answer[key], f"{where}.{key}")
        elif isinstance(shown, list):
            self.assertGreaterEqual(len(answer), len(shown), where)
            for index, value in enumerate(shown):
                self.assert_shape(value, answer[index], f"{where}[{index}]")
        elif isinstance(shown, (int, float)) and not isinstance(shown, bool):
            self.assertIsInstance(answer, (int, float), where)
            self.assertNotIsInstance(answer, bool, where)
        else:
            self.assertIs(type(answer), type(shown), where)


class Examples(DocumentTest):
    def test_the_first_request_returns_what_is_shown_and_validates(self):
        (block,) = blocks("README.md", "json")
        shown = json.loads(block)
        request = json.loads((PROJECT / "tests/scenarios/corridor-swap.json").read_text())
        answer = self.post("/v1/plan", request)
        self.assert_shape(shown, answer)
        self.assertEqual(shown["status"], answer["status"])
        self.assertAlmostEqual(shown["flowtime"], answer["flowtime"], delta=1.0)
        self.assertTrue(self.post("/v1/validate", {**request, **answer})["valid"])

    def test_the_request_of_the_api_page_returns_the_response_below_it(self):
        request, shown = first_request(), first_response()
        (verdict,) = map(json.loads, blocks("docs/endpoints.md", "json"))
        answer = self.post("/v1/plan", request)
        self.assert_shape(shown, answer)
        self.assertEqual(set(shown), set(answer))
        self.assertEqual(shown["status"], answer["status"])
        self.assertAlmostEqual(shown["flowtime"], answer["flowtime"], delta=0.01)
        self.assert_shape(self.post("/v1/validate", {**request, **answer}), verdict)

    def test_the_members_of_fleets_in_motion_are_accepted_and_planned(self):
        request, _, motion, _ = map(json.loads, blocks("docs/plan_request.md", "json"))
        request = {**request, **motion}
        answer = self.post("/v1/plan", request)
        self.assertEqual(answer["status"], "solved")
        (plan,) = answer["plans"]
        (committed,) = motion["robots"][0]["committed"]
        self.assertEqual(plan["actions"][0], committed)
        self.assertEqual([visit["goal"] for visit in plan["visits"]], [0, 1])
        self.assertGreaterEqual(plan["visits"][0]["t_leave"], 15.0)
        self.assertTrue(self.post("/v1/validate", {**request, **answer})["valid"])

    def test_the_goals_at_one_of_several_poses_are_served_at_the_best(self):
        request, poses, _, _ = map(json.loads, blocks("docs/plan_request.md", "json"))
        request = {**request, **poses}
        answer = self.post("/v1/plan", request)
        (plan,) = answer["plans"]
        self.assertEqual([visit["choice"] for visit in plan["visits"]], [0, 1])
        self.assertTrue(self.post("/v1/validate", {**request, **answer})["valid"])

    def test_the_zones_of_the_api_page_make_the_way_longer(self):
        request, _, _, zones = map(json.loads, blocks("docs/plan_request.md", "json"))
        shown = first_response()
        request = {**request, **zones}
        answer = self.post("/v1/plan", request)
        self.assertEqual(answer["status"], "solved")
        self.assertGreater(answer["flowtime"], shown["flowtime"] + 1.0)
        self.assertTrue(self.post("/v1/validate", {**request, **answer})["valid"])

    def test_the_error_of_the_api_page_is_returned_for_the_fault_that_it_shows(self):
        (shown,) = map(json.loads, blocks("docs/errors.md", "json"))
        request = first_request()
        request["robots"][0]["linear_speed"] = 0
        with self.assertRaises(urllib.error.HTTPError) as raised:
            self.post("/v1/plan", request)
        with raised.exception as response:
            answer = json.load(response)
        self.assert_shape(shown, answer)
        for member in ("status", "code", "detail", "errors"):
            self.assertEqual(shown[member], answer[member])

    def test_the_python_example_plans_for_every_robot(self):
        (program,) = blocks("docs/first_request.md", "python")
        self.assertIn(SERVICE, program)
        done = subprocess.run([sys.executable, "-c", program.replace(SERVICE, self.url)],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?s)\Asolved flowtime \d+\.\d+ s\nleft\n .*\nright\n .*\nparked\n\Z")

    def test_the_example_of_tasks_gives_each_robot_one(self):
        _, program = blocks("docs/assignment.md", "python")
        self.assertIn(SERVICE, program)
        done = subprocess.run([sys.executable, "-c", program.replace(SERVICE, self.url)],
                              env={**os.environ, "PYTHONPATH": str(PROJECT / "clients/python")},
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"\A(\w+ by amr-[12] after \d+\.\d s alone\n){2}solved after \d+\.\d s\n\Z")

    def test_the_matrix_for_solvers_of_routes_has_whole_numbers(self):
        program, _ = blocks("docs/assignment.md", "python")
        self.assertIn(SERVICE, program)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", program.replace(SERVICE, self.url)], cwd=folder,
                                  env={**os.environ, "PYTHONPATH": str(PROJECT / "clients/python")},
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            problem = json.loads((pathlib.Path(folder) / "problem.json").read_text())
        for matrix in problem["matrices"]["car"].values():
            self.assertEqual([len(row) for row in matrix], [3, 3, 3])
            self.assertTrue(all(type(number) is int for row in matrix for number in row))

    @unittest.skipUnless(shutil.which("curl") and shutil.which("jq"), "needs curl and jq")
    def test_the_shell_examples_with_curl_succeed(self):
        place = SERVICE.removeprefix("http://")
        examples = [(name, block) for name in DOCUMENTS for block in blocks(name, "sh")
                    if re.search(r"^(curl|gzip|jq) |map2request .*\|\n +curl ", block, re.MULTILINE)]
        self.assertIn("README.md", [name for name, _ in examples])
        for name, block in examples:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "tests").symlink_to(PROJECT / "tests")
                (pathlib.Path(folder) / ".curlrc").write_text("fail\nsilent\nshow-error\n")
                done = subprocess.run(
                    ["bash", "-euo", "pipefail", "-c", self.with_program(block).replace(place, self.url.removeprefix("http://"))],
                    cwd=folder, env={**os.environ, "CURL_HOME": folder}, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, block + done.stderr)
                self.assertNotEqual(done.stdout, "", block)

    @staticmethod
    def with_program(block):
        return block.replace("build/serve/server/fleetplan", str(pathlib.Path(BINARY).resolve()))

    def test_the_program_answers_from_files(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "tests").symlink_to(PROJECT / "tests")
            for block in blocks("docs/command_line.md", "sh"):
                subprocess.run(["bash", "-euo", "pipefail", "-c", self.with_program(block)], cwd=folder, check=True)
                self.assertEqual(json.loads((pathlib.Path(folder) / "plan.json").read_text())["status"], "solved")
            self.assertTrue((pathlib.Path(folder) / "warehouse.svg").read_text().startswith("<svg "))
            for name in ["warehouse.png", "hall.png"]:
                self.assertTrue((pathlib.Path(folder) / name).read_bytes().startswith(b"\x89PNG"))

    def test_the_events_have_the_names_that_are_shown(self):
        names = {variant["properties"]["event"]["const"] for variant in self.schema("PlanEvent")["oneOf"]}
        self.assertEqual({code(row[0])[0] for row in table("docs/plan_response.md", ["`event`"])}, names)
        shown = set(re.findall(r"^event: (\w+)$", DOCUMENTS["docs/plan_response.md"], re.MULTILINE))
        self.assertLessEqual(shown, names)


class ApiTables(DocumentTest):
    def test_the_options_are_those_of_the_schema(self):
        request = self.openapi["paths"]["/v1/plan"]["post"]["requestBody"]["content"]["application/json"]["schema"]
        options = self.resolve(self.resolve(request)["properties"]["options"])["properties"]
        rows = table("docs/plan_request.md", ["option", "range", "default", "meaning"])
        self.assertEqual([code(row[0])[0] for row in rows], list(options))
        budget = json.loads(self.get("/v1/limits"))["default_budget_ms"]  # the only default that is a setting
        for name, stated, default, _ in rows:
            name = code(name)[0]
            with self.subTest(name):
                option = self.resolve(options[name])
                self.assert_range(stated, option)
                shown = json.loads(code(default)[0]) if code(default) and code(default)[0] in ("true", "false", "null") else (
                    code(default)[0] if code(default) else float(default))
                self.assertEqual(shown, budget if name == "time_budget_ms" else option["default"])

    def assert_range(self, stated, option):
        if option["type"] == "boolean":
            self.assertEqual(code(stated), ["true", "false"])
            return
        if "enum" in option:
            self.assertEqual(code(stated), [str(value) for value in option["enum"]])
            return
        least, most = re.match(r"from (\S+?)(?: to ([\w.]+))?(?:,|$)", stated).groups()
        self.assertEqual(json.loads(least), option["minimum"])
        self.assertEqual(json.loads(most) if most else sys.float_info.max, option["maximum"])
        self.assertEqual(code(stated) == ["null"], "null" in option["type"])

    def test_the_paths_are_those_of_the_schema(self):
        documented = {f"{method.upper()} {path}" for path, operations in self.openapi["paths"].items()
                      for method in operations}
        for document in ("README.md", "docs/api.md"):
            listed = {name for row in table(document, ["method and path"]) for name in code(row[0])
                      if re.match(r"(GET|POST) ", name)}
            self.assertEqual(listed - {"GET /"}, documented, document)

    def test_the_errors_are_those_of_the_schema(self):
        errors = {(value["status"], value["code"]) for value in values(self.openapi["components"], "value")
                  if isinstance(value, dict) and "code" in value and "request_id" in value}
        rows = table("docs/errors.md", ["status", "`code`"])
        self.assertEqual({(int(status), code(name)[0]) for status, name, _ in rows}, errors)

    def test_faults_reasons_and_violations_are_those_of_the_schema(self):
        def listed(document, header):
            return {name for row in table(document, [header]) for name in code(row[0])}
        self.assertEqual(listed("docs/errors.md", "`errors[].code`"), set(self.schema("Fault")["properties"]["code"]["enum"]))
        self.assertEqual(listed("docs/plan_response.md", "`reason`"), set(self.schema("Unplanned")["properties"]["reason"]["enum"]))
        self.assertEqual(listed("docs/endpoints.md", "violation `kind`"), set(self.schema("Violation")["properties"]["kind"]["enum"]))


class ConfigurationTables(DocumentTest):
    def test_the_flags_and_their_defaults_are_those_of_the_help(self):
        text = subprocess.run([BINARY, "--help"], capture_output=True, text=True, check=True).stdout
        flags = set(re.findall(r"--[a-z-]+", text)) - {"--help", "--version"}
        rows = {code(row[0])[0]: row[1] for row in table("docs/configuration.md", ["flag", "default"])}
        self.assertEqual(set(rows), flags)
        # As CLI11 of Debian 12 and 13 prints them: "--port INT=8080 (Env:", "--port INT [8080]  (Env:".
        stated = r"^  (--[a-z-]+) .*(?:=([^=\[\]]+?)| \[([^\]]+)\] )(?: \.\.\.)? \(Env:"
        defaults = {flag: old or new for flag, old, new in re.findall(stated, text, re.MULTILINE)}
        self.assertGreater(len(defaults), 12)
        of_the_machine = {"--workers", "--web-root"}
        for flag, default in defaults.items():
            if flag not in of_the_machine:
                self.assertEqual(rows[flag], default, flag)

    def test_the_metrics_are_those_of_the_service(self):
        families = set(re.findall(r"^# HELP (fleetplan_\w+)", self.get("/metrics"), re.MULTILINE))
        rows = table("docs/configuration.md", ["metric"])
        self.assertEqual({re.match(r"\w+", code(row[0])[0]).group() for row in rows}, families)


class ManualPage(unittest.TestCase):
    """The manual page has the commands and options of the help."""

    PAGE = (PROJECT / "docs" / "fleetplan.1").read_text().replace("\\-", "-")

    @staticmethod
    def help_of(*arguments):
        return subprocess.run([BINARY, *arguments, "--help"], capture_output=True, text=True, check=True).stdout

    def options_of(self, section):
        """The options that a section describes, each after a tag."""
        return set(re.findall(r"^\.TP\n\.B\S* .*?(--[a-z0-9-]+)", section, re.MULTILINE))

    def options_in(self, text):
        return set(re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", text, re.MULTILINE))

    def test_it_has_the_commands_with_their_options(self):
        common, *parts = self.PAGE.partition(".SH COMMANDS")[2].partition(".SH ")[0].split(".SS ")
        shared = set(re.findall(r"^\.BR? (--[a-z-]+)(?: [,.])?$", common, re.MULTILINE)) - {"--help"}
        described = {re.match(r"[a-z0-9-]+", part.strip('"')).group(): part for part in parts}
        listed = subprocess.run([BINARY, "help"], capture_output=True, text=True, check=True).stdout
        names = re.findall(r"^  ([a-z][a-z0-9-]+) ", listed.partition("Subcommands:")[2], re.MULTILINE)
        self.assertEqual(list(described), names)
        for name in set(names) - {"serve"}:
            wanted = self.options_of(described[name])
            if "REQUEST" in described[name].partition("\n")[0]:
                wanted |= shared
            elif name == "map2request":
                wanted |= shared - {"--workers"}
            self.assertEqual(wanted, self.options_in(self.help_of(name)) - {"--help"}, name)

    def test_it_has_the_options_of_the_server(self):
        section = self.PAGE.partition(".SH OPTIONS")[2].partition(".SH ")[0]
        self.assertEqual(self.options_of(section), self.options_in(self.help_of("serve")))

    def test_it_has_the_exit_codes_of_the_document(self):
        section = self.PAGE.partition(".SH EXIT STATUS")[2].partition(".SH ")[0]
        self.assertEqual(re.findall(r"^\.B (\d+)$", section, re.MULTILINE),
                         [row[0] for row in table("docs/command_line.md", ["exit code"])])

    @unittest.skipUnless(shutil.which("groff"), "needs groff")
    def test_it_is_formatted_without_warnings(self):
        done = subprocess.run(["groff", "-man", "-ww", "-z", PROJECT / "docs" / "fleetplan.1"],
                              capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")


class Names(unittest.TestCase):
    def test_the_readme_is_short(self):
        self.assertLessEqual(len(DOCUMENTS["README.md"].splitlines()), 120)

    def test_lines_outside_of_tables_and_code_have_at_most_120_columns(self):
        for name, text in DOCUMENTS.items():
            outside = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
            self.assertEqual([line for line in outside.splitlines() if len(line) > 120 and not line.startswith("|")], [], name)

    def test_the_version_is_that_of_the_build_everywhere(self):
        def stated(file, pattern):
            return re.findall(pattern, (PROJECT / file).read_text(), re.MULTILINE)
        (version,) = stated("CMakeLists.txt", r"^project\(fleetplan VERSION (\S+)")
        self.assertEqual(stated("Dockerfile", r'image\.version="([^"]*)"'), [version])
        self.assertEqual(json.loads((PROJECT / "api/openapi.json").read_text())["info"]["version"], version)
        self.assertEqual(stated("deploy/kubernetes/overlays/example/kustomization.yaml", r"newTag: (\S+)"), [version])
        (required,) = stated("examples/CMakeLists.txt", r"find_package\(fleetplan (\S+)")
        self.assertTrue(version.startswith(required + "."), required)

    def test_the_packages_are_those_of_the_scripts(self):
        library = (PROJECT / "scripts/lib.sh").read_text()
        lists = {name: [package.split(":")[0] for package in packages.split()]
                 for name, packages in re.findall(r"^(\w+)_PACKAGES=\((.*?)\)", library, re.MULTILINE | re.DOTALL)}
        wanted = [lists["BUILD"], lists["UNIT_TEST"], lists["TEST"], lists["CHECK"] + lists["FUZZ"]]
        self.assertEqual([code(row[1]) for row in table("CONTRIBUTING.md", ["for", "packages"])], wanted)

    def test_every_path_that_is_named_exists(self):
        folders = "|".join(sorted(p.name for p in PROJECT.iterdir() if p.is_dir() and p.name not in (".git", "build")))
        for name, text in DOCUMENTS.items():
            if name == "CHANGELOG.md":
                continue
            for path in re.findall(rf"(?<![\w/.@-])((?:{folders})/[\w./-]*\w)", text):
                self.assertTrue((PROJECT / path).exists(), f"{name} names {path}")

    def test_the_names_of_the_page_of_the_server_are_those_of_files_and_of_the_sources(self):
        names = set(re.findall(r"`([^`\n]+)`", prose(DOCUMENTS["docs/http.md"])))
        paths = {name for name in names if re.fullmatch(r"[\w.-]+(/[\w.-]+)+/?", name)}
        self.assertGreater(len(paths), 10)
        self.assertEqual([path for path in sorted(paths) if not (PROJECT / path).exists()], [])
        for number, files, _ in table("docs/http.md", ["", "File", "What happens"]):
            self.assertNotEqual(code(files), [], number)
            for file in code(files):
                self.assertTrue((PROJECT / file).is_file(), f"row {number} names {file}")
        files = [path for folder in ("server", "tests/fuzz", "tests/server")
                 for path in (PROJECT / folder).rglob("*") if path.suffix in (".h", ".cpp")]
        sources = "\n".join(path.stem + "\n" + path.read_text() for path in files)
        words = {name for name in names if re.fullmatch(r"[a-z]+(_[a-z]+)+|([A-Z][a-z]+){2,}", name)}
        self.assertGreater(len(words), 10)
        self.assertEqual([word for word in sorted(words) if not re.search(rf"\b{word}\b", sources)], [])

    def test_members_of_classes_that_the_architecture_page_names_exist(self):
        sources = "\n".join(path.read_text() for folder in ("core", "api", "server", "library", "include")
                            for path in (PROJECT / folder).rglob("*.h"))
        names = set(re.findall(r"`([^`\n]+)`", DOCUMENTS["docs/architecture.md"]))
        members = {name for name in names if re.fullmatch(r"(\w+::)+\w+", name) and not name.startswith("std::")}
        self.assertGreater(len(members), 10)
        for name in sorted(members):
            *scopes, member = name.split("::")
            for word in [scopes[-1], member]:
                self.assertRegex(sources, rf"\b{word}\b", name)

    def test_the_tolerances_are_in_the_files_that_the_page_of_the_check_names(self):
        for constant, _, file, _ in table("docs/checker.md", ["constant", "value", "file"]):
            self.assertIn(f"double {code(constant)[0]} = ", (PROJECT / code(file)[0]).read_text())

    def test_every_link_leads_to_a_file_and_a_heading(self):
        for name, text in DOCUMENTS.items():
            for target in re.findall(r"\]\(([^)\s]+)\)|src=\"([^\"]+)\"", prose(text)):
                target = "".join(target)
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, heading = target.partition("#")
                file = (PROJECT / name).parent / path if path else PROJECT / name
                self.assertTrue(file.exists(), f"{name} links to {target}")
                if heading:
                    headings = re.findall(r"^#+ (.*)$", prose(file.read_text()), re.MULTILINE)
                    self.assertIn(heading, [anchor(h) for h in headings], f"{name} links to {target}")


class KeptAnswers(DocumentTest):
    """What docs/compatibility.md promises: requests of earlier releases are accepted, members of answers stay."""

    KEPT = sorted((PROJECT / "tests" / "compatibility").glob("*/*.json"))

    @classmethod
    def members(cls, node, path=""):
        """The types of each member, by its path without numbers of items."""
        found = {path: {"number" if type(node) in (int, float) else type(node).__name__}}
        children = (node.items() if isinstance(node, dict) else
                    [("[]", item) for item in node] if isinstance(node, list) else [])
        for key, child in children:
            for place, types in cls.members(child, f"{path}/{key}").items():
                found.setdefault(place, set()).update(types)
        return found

    def test_requests_of_earlier_releases_get_answers_with_the_same_members(self):
        self.assertGreater(len(self.KEPT), 10)
        for file in self.KEPT:
            with self.subTest(str(file.relative_to(PROJECT))):
                kept = json.loads(file.read_text())
                before = self.members(kept["answer"])
                now = self.members(self.post(kept["path"], kept["request"]))
                self.assertEqual([place for place in before if place not in now], [])
                self.assertEqual([place for place in before if not before[place] & now[place]], [])

    def test_a_member_that_is_missing_or_of_another_type_is_found(self):
        self.assertEqual(self.members({"a": [1, {"b": None}]}),
                         {"": {"dict"}, "/a": {"list"}, "/a/[]": {"number", "dict"}, "/a/[]/b": {"NoneType"}})


class Words(unittest.TestCase):
    """The documents are read once: few phrases that point back, few long sentences."""

    MAX_PHRASES = 30  # in all documents together
    MAX_LONG_SHARE = 0.1  # of the sentences of a page
    MAX_MEAN = 20.0  # words a sentence of a page

    @classmethod
    def setUpClass(cls):
        cls.pages = {name: words.measure(text) for name, text in DOCUMENTS.items()}
        print(words.table())

    def test_few_phrases_point_back(self):
        self.assertLess(sum(phrases for phrases, *_ in self.pages.values()), self.MAX_PHRASES)

    def test_few_sentences_are_long(self):
        self.assertEqual([name for name, (_, _, _, share) in self.pages.items() if share >= self.MAX_LONG_SHARE], [])

    def test_sentences_are_short_in_the_mean(self):
        self.assertEqual([name for name, (_, _, mean, _) in self.pages.items() if mean > self.MAX_MEAN], [])

    def test_the_measure_counts_sentences_of_paragraphs_items_and_cells(self):
        text = "\n".join(["# A heading does not count", "", "The `first code` has [two words](u.md)", "and more. Next.", "",
                          "- An item", "  of a list", "- is its own sentence", "", "```", "not this, none of them", "```", "",
                          "| a | cell of four words |", "|---|---|", "| one that is short | 2 |"])
        self.assertEqual([count for count, _ in words.sentences(text)], [7, 1, 5, 4, 4, 4])
        self.assertEqual(len(words.phrases(text)), 1)
        long = " ".join(["word"] * 31) + ". Short."
        self.assertEqual(words.measure(long), (0, 2, 16.0, 0.5))


del DocumentTest  # not a test of its own

if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
