#!/usr/bin/env python3
"""The tables of docs/scenes.md, from the program: scene_reference.py PERCALE [--check]

Replaces what follows the marker in docs/scenes.md by the parameters that `percale check --schema`
describes. With --check changes nothing and exits 1 if the page is out of date.
"""

import json
import os
import re
import subprocess
import sys

PAGE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "scenes.md")
MARKER = "<!-- From here on written by tools/scene_reference.py from the program's own table. -->\n"


def resolve(schema, node):
    """Follows a reference within the schema."""
    while "$ref" in node:
        target = schema
        for part in node["$ref"].lstrip("#/").split("/"):
            target = target[part]
        node = {**target, **{key: value for key, value in node.items() if key != "$ref"}}
    return node


def object_of(schema, node):
    """The object that a group is, and whether an array of them may stand in its place."""
    node = resolve(schema, node)
    for alternative in node.get("oneOf", node.get("anyOf", [])):
        alternative = resolve(schema, alternative)
        if alternative.get("type") == "object":
            return {**alternative, "description": node.get("description", alternative.get("description", ""))}, True
    return node, False


def number(value):
    return f"{value:g}" if abs(value) < 1e16 else f"{value:.0e}"


def kind(schema, node):
    """What a value must be, in words."""
    node = resolve(schema, node)
    if "enum" in node:
        return ", ".join(f"`{json.dumps(choice)}`" for choice in node["enum"])
    name = node.get("type")
    if name == "array":
        items = resolve(schema, node.get("items", {}))
        if "anyOf" in items:
            return "points [i, j], vertices"
        return "three numbers" + bounds(items)
    words = {"number": "number", "integer": "whole number", "boolean": "true, false", "string": "text"}
    return words[name] + bounds(node)


def bounds(node):
    """The bounds worth naming; those that only keep sums finite are left to the error messages."""
    low = node.get("minimum", node.get("exclusiveMinimum"))
    high = node.get("maximum")
    low = None if low is None or abs(low) > 1e4 else low
    high = None if high is None or abs(high) > 1e4 else high
    more = "> " if "exclusiveMinimum" in node else "≥ "
    if low is not None and high is not None and "minimum" in node:
        return f", {number(low)} to {number(high)}"
    parts = ([more + number(low)] if low is not None else []) + (["≤ " + number(high)] if high is not None else [])
    return " " + ", ".join(parts) if parts else ""


def default(node):
    if "default" not in node:
        return ""
    return f"`{json.dumps(node['default'])}`"


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def tables(schema):
    lines = []
    for group, node in schema["properties"].items():
        node, array = object_of(schema, node)
        required = node.get("required", [])
        lines += ["", f"### {group}" + (" (one, or an array)" if array else ""), "", cell(node.get("description", "")), "",
                  "| key | value | default | |", "|---|---|---|---|"]
        for key, parameter in node["properties"].items():
            parameter = resolve(schema, parameter)
            stated = "required" if key in required else default(parameter)
            # The schema has no place for units; they end the description.
            text, unit = re.fullmatch(r"(.*?)( \[[^\]]+\])?", parameter.get("description", ""), re.DOTALL).groups()
            lines.append(f"| `{key}` | {cell(kind(schema, parameter) + (unit or ''))} | {cell(stated)} | {cell(text)} |")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (2, 3) or (len(sys.argv) == 3 and sys.argv[2] != "--check"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    schema = json.loads(subprocess.run([sys.argv[1], "check", "--schema"], check=True, capture_output=True).stdout)
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    if MARKER not in page:
        print(f"{PAGE}: expected the line {MARKER.strip()}", file=sys.stderr)
        return 1
    wanted = page[:page.index(MARKER)] + MARKER + tables(schema)
    if wanted == page:
        return 0
    if len(sys.argv) == 3:
        print(f"docs/scenes.md is out of date; remedy: tools/scene_reference.py {sys.argv[1]}", file=sys.stderr)
        return 1
    with open(PAGE + ".part", "w", encoding="utf-8") as file:
        file.write(wanted)
    os.replace(PAGE + ".part", PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
