#!/usr/bin/env python3
"""Checks that every key of a config is in a page or in a shipped config: `ctest -R "style: keys"`.

keys_are_documented.py PROJECT SCHEMAS     SCHEMAS is the folder of JSON Schemas that the build writes
A key that nobody can find is of no use: document it, use it, or remove it.
"""
import json
import re
import sys
from pathlib import Path

ROOT, SCHEMAS = Path(sys.argv[1]), Path(sys.argv[2])


def keys_of(schema, found):
    """All names of properties, at any depth of a JSON schema."""
    if isinstance(schema, list):
        for part in schema:
            keys_of(part, found)
    if isinstance(schema, dict):
        found.update(schema.get("properties", {}))
        for part in schema.values():
            keys_of(part, found)


def main():
    keys = set()
    for path in SCHEMAS.glob("*.json"):
        keys_of(json.loads(path.read_text()), keys)
    if len(keys) < 200:
        sys.exit(f"only {len(keys)} keys in {SCHEMAS}: build everything, or this script no longer reads the schemas")
    pages = [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]
    configs = [path for folder in ("configs", "pipelines", "share/new") for path in (ROOT / folder).rglob("*.yaml")]
    words = set(re.findall(r"\w+", "\n".join(path.read_text() for path in pages + configs)))
    found = sorted(keys - words)
    print(f"{len(keys)} keys, {len(found)} in no page and no config")
    for key in found:
        print(f"{key}: in no page of docs/ and no config; document it, use it, or remove it")
    return 1 if found else 0


sys.exit(main())
