"""check_crate.py <folder>: whether a folder is an RO-Crate 1.1 that holds: what the specification requires of the metadata, that every file
has the checksum and size told, that every reference leads somewhere, and that every step has its inputs and results."""
import hashlib
import json
import re
import sys
from pathlib import Path
from urllib.parse import unquote

folder = Path(sys.argv[1])
crate = json.loads((folder / "ro-crate-metadata.json").read_text(encoding="utf-8"))
assert crate["@context"] == "https://w3id.org/ro/crate/1.1/context"
graph = crate["@graph"]
entities = {e["@id"]: e for e in graph}
assert len(entities) == len(graph), "an @id stands twice"
assert all("@type" in e for e in graph)

descriptor = entities["ro-crate-metadata.json"]
assert graph[0] is descriptor and descriptor["@type"] == "CreativeWork"
assert descriptor["conformsTo"] == {"@id": "https://w3id.org/ro/crate/1.1"}
assert descriptor["about"] == {"@id": "./"}
root = entities["./"]
assert root["@type"] == "Dataset"
for key in ("name", "description", "datePublished", "license"):
    assert root[key], f"the root has no {key}"
assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", root["datePublished"])


def references(value):
    if isinstance(value, dict):
        if set(value) == {"@id"}:
            yield value["@id"]
        for v in value.values():
            yield from references(v)
    elif isinstance(value, list):
        for v in value:
            yield from references(v)


outside = {"https://w3id.org/ro/crate/1.1", "http://schema.org/CompletedActionStatus"}
for e in graph:
    for target in references({k: v for k, v in e.items() if k != "@id"}):
        assert target in entities or target in outside, f"{e['@id']} leads to {target}, which is not described"

parts = {p["@id"] for p in root["hasPart"]}
files = [e for e in graph if e["@type"] == "File"]
assert {e["@id"] for e in files} == parts
for e in files:
    data = (folder / unquote(e["@id"])).read_bytes()
    assert hashlib.sha256(data).hexdigest() == e["sha256"], f"{e['@id']}: another checksum"
    assert str(len(data)) == e["contentSize"], f"{e['@id']}: another size"
    assert "/" in e["encodingFormat"]
there = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
assert there - {unquote(p) for p in parts} == {"ro-crate-metadata.json"}, there - parts

actions = [entities[a["@id"]] for a in root["mentions"]]
assert actions and all(a["@type"] == "CreateAction" for a in actions)
for a in actions:
    assert entities[a["instrument"]["@id"]]["@type"] == "SoftwareApplication"
    assert entities[a["instrument"]["@id"]]["version"]
    assert a["object"] and a["result"] and a["name"]
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", a["startTime"]) and a["endTime"] >= a["startTime"], a
made = [r["@id"] for a in actions for r in a["result"]]
assert len(made) == len(set(made)), "a file is the result of two steps"
# every result comes from configs and inputs that lie in the crate: nothing is made out of nowhere
known = {e["@id"] for e in files if e["@id"].endswith(".yaml") or e["@id"].startswith("inputs.d/")}
for _ in actions:
    for a in actions:
        if all(o["@id"] in known for o in a["object"]):
            known |= {r["@id"] for r in a["result"]}
for a in actions:
    assert all(o["@id"] in known for o in a["object"]), a
print(f"{len(files)} files, {len(actions)} steps, {sum(e['@type'] == 'PropertyValue' for e in graph)} numbers")
