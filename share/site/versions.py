#!/usr/bin/env python3
"""Lists the versions of the site, which the theme offers as a menu, and sends its front page to the newest one.

versions.py SITE     SITE holds a folder for each version, such as 0.3.0
The form of versions.json is that of mike, which the theme reads.
"""
import json
import sys
from pathlib import Path

site = Path(sys.argv[1])
folders = [path.parent.name for path in site.glob("*/index.html")]
numbered = sorted((name for name in folders if name.replace(".", "").isdigit()), key=lambda name: [int(part) for part in name.split(".")], reverse=True)
if not numbered:
    sys.exit(f"{site}: no version has an index.html")
versions = [{"version": name, "title": name, "aliases": ["latest"] if name == numbered[0] else []} for name in numbered]
(site / "versions.json").write_text(json.dumps(versions, indent=2) + "\n")
(site / "index.html").write_text(
    f'<!doctype html>\n<meta charset="utf-8">\n<title>Langer</title>\n<meta http-equiv="refresh" content="0; url={numbered[0]}/index.html">\n'
    f'<a href="{numbered[0]}/index.html">Langer {numbered[0]}</a>\n')
print(f"{len(numbered)} versions in {site}: {', '.join(numbered)}")
