"""The types of the client and the parameters of its methods agree with the OpenAPI document."""

import inspect
import json
import types
import typing
import unittest

from support import PROJECT

import fleetplan.types
from fleetplan import Client

DOCUMENT = json.loads((PROJECT / "api/openapi.json").read_text())
SCHEMAS = DOCUMENT["components"]["schemas"]

# Schemas with a type of the same name are found by it. These have another type. Either the answer of the service and
# its input have the same type here, or the type is only part of one.
OTHER_NAMES = {"GivenAction": "Action", "GivenMotion": "Action", "GivenPose": "Pose"}
# Members of answers that requests may have, so that answers can be sent back.
OF_ADVANCE = {"progress", "unavoidable", "unavoidable_total"}
OF_ASSIGN = {"assigned", "unassigned"}
IGNORED = {"PlanRequest": OF_ADVANCE | OF_ASSIGN, "AdvanceAnswer": OF_ASSIGN, "AssignAnswer": OF_ADVANCE}
# `problem` is raised.
WITHOUT = {"PlanEvent": 3, "SimulationEvent": 2, "MarginsEvent": 2}


def resolve(schema):
    """A schema with what it refers to."""
    if "$ref" in schema:
        return {**resolve(SCHEMAS[schema["$ref"].rpartition("/")[2]]), **{k: v for k, v in schema.items() if k != "$ref"}}
    merged = dict(schema)
    for part in schema.get("allOf", []):
        part = resolve(part)
        merged["properties"] = {**part.get("properties", {}), **merged.get("properties", {})}
        merged["required"] = [*part.get("required", []), *merged.get("required", [])]
        merged.setdefault("type", part.get("type"))
    return merged


def alternatives(annotation):
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        return list(typing.get_args(annotation))
    return [annotation]


class Comparison(unittest.TestCase):
    def compare(self, schema, annotation, where):
        """The annotation describes what the schema does."""
        schema = resolve(schema)
        kinds = schema.get("type")
        if annotation == fleetplan.types.VdaMessage and kinds == "object":
            pass  # a message of VDA 5050, of which the schema has what is read
        elif "oneOf" in schema and "properties" not in schema:
            self.compare_alternatives(schema["oneOf"], alternatives(annotation), where)
        elif isinstance(kinds, list):
            self.assertIn(type(None), alternatives(annotation), where)
            (kind,) = set(kinds) - {"null"}
            (rest,) = [one for one in alternatives(annotation) if one is not type(None)]
            self.compare({**schema, "type": kind}, rest, where)
        elif schema.get("const") is True and annotation is bool:
            pass  # the same type is for what the service is given, which may be false
        elif "const" in schema or "enum" in schema:
            self.assertEqual(typing.get_origin(annotation), typing.Literal, where)
            self.assertEqual(set(map(str, typing.get_args(annotation))),
                             set(map(str, schema.get("enum", [schema.get("const")]))), where)
        elif kinds == "object" and "properties" in schema:
            self.compare_members(schema, annotation, where)
        elif kinds == "object":
            self.assertIs(typing.get_origin(annotation), dict, where)
        elif kinds == "array":
            self.assertIs(typing.get_origin(annotation), list, where)
            self.compare(schema["items"], typing.get_args(annotation)[0], where + "[]")
        elif kinds is not None:  # otherwise the schema allows anything
            self.assertIs(annotation, {"string": str, "number": float, "integer": int, "boolean": bool}[kinds], where)

    def compare_alternatives(self, schemas, annotations, where):
        schemas = [resolve(schema) for schema in schemas]
        if {"type": "null"} in schemas:
            schemas.remove({"type": "null"})
            annotations.remove(type(None))
        self.assertGreaterEqual(len(schemas), len(annotations), where)
        self.assertEqual(len(annotations), WITHOUT.get(where, len(schemas)), where)
        for schema, annotation in zip(schemas, annotations):
            self.compare(schema, annotation, f"{where}/{getattr(annotation, '__name__', annotation)}")

    def compare_members(self, schema, annotation, where):
        self.assertTrue(typing.is_typeddict(annotation), f"{where}: {annotation}")
        self.assertEqual(set(annotation.__annotations__), set(schema["properties"]) - IGNORED.get(where, set()), where)
        self.assertEqual(annotation.__required_keys__, set(schema.get("required", [])), where)
        for name, kind in typing.get_type_hints(annotation).items():
            self.compare(schema["properties"][name], kind, getattr(kind, "__name__", f"{where}.{name}"))


class Types(Comparison):
    def test_they_have_the_members_of_the_schemas(self):
        compared = 0
        for name, schema in SCHEMAS.items():
            annotation = getattr(fleetplan.types, OTHER_NAMES.get(name, name), None)
            if annotation is None:
                continue
            with self.subTest(name):
                self.compare(schema, annotation, name)
            compared += 1
        self.assertGreater(compared, 40)


class Methods(Comparison):
    """What the methods send is what the schemas of requests have."""

    PLANS = {"request": {"map", "robots", "robot_defaults", "obstacles", "zones", "options", "metadata"},
             "plans": {"plans", "unavoidable", "dependencies"}}
    PARTS = {"request": {"robots", "robot_defaults", "options"}, "plans": {"plans", "dependencies"}}
    ANSWERS = {"status", "request_id", "unplanned", "tight", "flowtime", "makespan", "objective_value", "lower_bound", "estimated",
               "verified", "min_clearance", "deterministic", "lattice_spacing", "search", "timings_ms", "warnings", "metadata", "map",
               "progress", "unavoidable_total", "assigned", "unassigned"}  # members that requests may have so that answers can be merged into them

    def compare_method(self, name, path, spread):
        schema = resolve(DOCUMENT["paths"][path]["post"]["requestBody"]["content"]["application/json"]["schema"])
        method = getattr(Client, name)
        hints = typing.get_type_hints(method)
        parameters = dict(inspect.signature(method).parameters)
        del parameters["self"]
        sent, required = set(), set()
        for parameter in parameters.values():
            members = spread.get(parameter.name, {parameter.name})
            sent |= members
            if parameter.default is parameter.empty:
                required |= members
            if members == {parameter.name} and parameter.name not in ("request", "plans"):
                self.compare_parameter(schema["properties"][parameter.name], hints[parameter.name], f"{name}.{parameter.name}")
        self.assertEqual(sent - set(schema["properties"]), set(), name)
        self.assertEqual(set(schema["properties"]) - sent - self.ANSWERS, set(), name)
        optional_here = {"timestamp"}  # now, unless it is given
        self.assertEqual(set(schema["required"]) - required - optional_here, set(), name)

    def compare_parameter(self, schema, hint, where):
        kinds = [one for one in alternatives(hint) if one is not type(None)]
        kind = kinds[0]
        if typing.get_origin(kind) is not None and typing.get_origin(kind).__name__ in ("Sequence", "Mapping"):
            schema, kind = schema.get("items", schema.get("additionalProperties")), typing.get_args(kind)[-1]
        self.compare(schema, kind, where)

    def test_they_have_the_members_of_requests(self):
        self.compare_method("validate", "/v1/validate", self.PLANS)
        self.compare_method("dependencies", "/v1/dependencies", {**self.PLANS, "plans": {*self.PLANS["plans"], "tolerance"}})
        self.compare_method("simulate", "/v1/simulate", self.PLANS)
        self.compare_method("simulate_events", "/v1/simulate", self.PLANS)
        self.compare_method("margins", "/v1/margins", {"try_": {"try"}})
        self.compare_method("margins_events", "/v1/margins", {"try_": {"try"}})
        self.compare_method("advance", "/v1/advance", {})
        self.compare_method("retime", "/v1/retime", self.PARTS)
        self.compare_method("matrix", "/v1/matrix", {"request": {"map", "zones", "options"}, "from_": {"from"}})
        self.compare_method("assign", "/v1/assign", {})
        self.compare_method("export_vda5050", "/v1/export/vda5050", self.PARTS)
        self.compare_method("import_vda5050", "/v1/import/vda5050", self.PARTS)

    def test_they_return_the_types_of_answers(self):
        paths = {"plan": "/v1/plan", "validate": "/v1/validate", "dependencies": "/v1/dependencies",
                 "simulate": "/v1/simulate", "margins": "/v1/margins", "advance": "/v1/advance", "retime": "/v1/retime",
                 "matrix": "/v1/matrix", "assign": "/v1/assign",
                 "export_vda5050": "/v1/export/vda5050", "import_vda5050": "/v1/import/vda5050", "limits": "/v1/limits", "health": "/healthz"}
        for name, path in paths.items():
            with self.subTest(name):
                (operation,) = DOCUMENT["paths"][path].values()
                schema = operation["responses"]["200"]["content"]["application/json"]["schema"]
                self.assertEqual(typing.get_type_hints(getattr(Client, name))["return"].__name__,
                                 schema["$ref"].rpartition("/")[2])


del Comparison

if __name__ == "__main__":
    unittest.main()
