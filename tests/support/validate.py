#!/usr/bin/env python3
"""Configs against their JSON Schemas:  validate.py SCHEMAS FILE...   prints each file that does not fit, and why.

The schema of a file is the one its line `# yaml-language-server: $schema=...` names. With --broken each file is broken in a few
ways first, and what the schema lets pass is an error. Exit code 77: the Python modules are not installed."""
import copy
import functools
import json
import os
import re
import sys

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


class Loader(yaml.SafeLoader):
    """YAML 1.2: 1e-6 is a number; on, off, yes and no are words."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in [
    ("bool", r"^(?:true|false)$", "tf"),
    ("int", r"^[-+]?(?:0|[1-9][0-9]*)$", "-+0123456789"),
    ("float", r"^[-+]?(?:[0-9]+\.[0-9]*|\.?[0-9]+)(?:[eE][-+]?[0-9]+)?$", "-+0123456789."),
    ("null", r"^(?:null|~|)$", ["n", "~", ""]),
]:
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(pattern), list(first))


def load(path):
    with open(path) as file:
        return yaml.load(file, Loader)


@functools.cache
def validator(path):
    with open(path) as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def errors(path, data):
    with open(path) as file:
        line = re.search(r"^# yaml-language-server: \$schema=(\S+)$", file.read(), re.M)
    if not line:
        return [f"{path}: no line names its schema"]
    found = validator(os.path.join(os.path.dirname(path), line[1])).iter_errors(data)
    return [f"{path}: {'.'.join(map(str, e.absolute_path))}: {e.message}" for e in found]


def broken(data):
    """(what was done, the data) for each way to break a map"""
    one = copy.deepcopy(data)
    one["no_such_key"] = 1
    yield "a key too many", one
    for key, value in data.items():
        wrong = copy.deepcopy(data)
        wrong[key] = {"no_such_key": 1} if not isinstance(value, dict) else 3
        yield f"{key} of another type", wrong
    if "include" not in data:
        yield "an empty map", {}


def optional(path):  # no key of a config of gather or sensitivity is required, and of fit none in all
    return "/gather/" in path or "/sensitivity/" in path or "/fit/" in path


complaints = []
checked = 0
for path in [a for a in sys.argv[1:] if not a.startswith("--")]:
    data = load(path)
    if "--broken" in sys.argv:
        for what, wrong in broken(data):
            if what == "an empty map" and optional(path):
                continue
            checked += 1
            if not errors(path, wrong):
                complaints.append(f"{path}: {what} is let pass")
    else:
        checked += 1
        complaints += errors(path, data)
print(*complaints, f"{checked} checked", sep="\n")
sys.exit(1 if complaints else 0)
