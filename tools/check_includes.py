#!/usr/bin/env python3
"""Checks what includes what: check_includes.py [ROOT]

Includes point one way between the rooms of the project, public headers need the standard library
only, and each heavy header has one home. Prints FILE:LINE: MESSAGE for each violation and exits 1
if there is one.
"""

import fnmatch
import os
import re
import sys

# Each room and those that it may include besides itself.
ROOMS = {
    "core": [],
    "math": ["core"],
    "mesh": ["math", "core"],
    "collide": ["mesh", "math", "core"],
    "springs": ["collide", "mesh", "math", "core"],
    "fabric": ["collide", "mesh", "math", "core"],
    "world": ["springs", "fabric", "collide", "mesh", "math", "core"],
    "io": ["world", "mesh", "math", "core"],
    "render": ["io", "world", "collide", "mesh", "math", "core"],
    "bench": ["io", "world", "springs", "fabric", "collide", "mesh", "math", "core"],
    "apps": ["bench", "render", "io", "world", "springs", "fabric", "collide", "mesh", "math", "core"],
}
# Tests may include everything.
ROOMS["tests"] = list(ROOMS)

# The room that each public header belongs to. The plain data of a scene counts as mesh: all
# engines read it.
PUBLIC = {
    "diagnostic.h": "core",
    "vec3.h": "math",
    "mesh.h": "mesh",
    "scene.h": "mesh",
    "rest_mesh.h": "mesh",
    "vertex_cache.h": "mesh",
    "fabrics.h": "mesh",
    "interaction.h": "mesh",
    "contacts.h": "world",
    "intersections.h": "world",
    "parameters.h": "world",
    "world.h": "world",
    "scene_file.h": "io",
    "checkpoint_file.h": "io",
    "mesh_file.h": "io",
}

# Heavy headers: what the include looks like, and the only files that may have it. "one:" marks a
# header that is so slow to compile that a single file may have it.
HEAVY = [
    (r"nlohmann/.*", "nlohmann-json", ["io/*.cpp"]),
    (r"CLI/.*", "CLI11", ["one:apps/cli/*.cpp"]),
    (r"(oneapi/)?tbb/.*|oneapi/.*", "oneTBB", ["src/core/executor.cpp"]),
    (r"(epoxy|GL|GLES\d|EGL)/.*", "OpenGL", ["render/*.cpp", "apps/viewer/*", "tests/render/*.cpp", "tests/viewer/*.cpp"]),
    (r"GLFW/.*", "GLFW", ["render/*.cpp", "apps/viewer/*", "tests/viewer/*.cpp"]),
    (r"(imgui|imgui_.*|backends/imgui_.*)\.h", "Dear ImGui", ["apps/viewer/*"]),
    (r"png\.h", "libpng", ["render/*.cpp"]),
    (r"doctest/.*|doctest\.h", "doctest", ["tests/*"]),
    (r"(unsupported/)?Eigen/.*", "Eigen", ["src/math/*.cpp", "src/fabric/*.cpp", "tests/*"]),
]

STANDARD = set("""
algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits
clocale cmath compare complex concepts condition_variable coroutine csetjmp csignal cstdarg cstddef cstdint cstdio
cstdlib cstring ctime cuchar cwchar cwctype deque exception execution filesystem format forward_list fstream functional
future initializer_list iomanip ios iosfwd iostream istream iterator latch limits list locale map memory
memory_resource mutex new numbers numeric optional ostream queue random ranges ratio regex scoped_allocator semaphore
set shared_mutex source_location span sstream stack stdexcept stop_token streambuf string string_view strstream
syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray
variant vector version
""".split())

# Standard, but not in every compiler that builds the project.
TOO_NEW = {"format", "expected", "source_location", "print", "generator", "mdspan", "flat_map", "flat_set", "stacktrace"}

SUFFIXES = (".h", ".hpp", ".inl", ".c", ".cpp", ".mm")
FOLDERS = ["include", "src", "io", "render", "bench", "apps", "tests"]


def room_of(path):
    """The room of a file of the project, or None; `path` is relative to the root."""
    parts = path.split("/")
    if parts[:2] == ["include", "percale"]:
        return PUBLIC.get("/".join(parts[2:]))
    if parts[0] == "src":
        return parts[1] if len(parts) > 2 and parts[1] in ROOMS else None
    return parts[0] if parts[0] in ROOMS else None


def without_comments(text):
    """The text with comments and the insides of strings blanked out, line for line. The names of
    quoted includes stay."""
    pattern = re.compile(
        r'(?P<include>^[ \t]*\#[ \t]*include[ \t]*"[^"\n]*")'
        r'|(?P<comment>//[^\n]*|/\*.*?\*/)'
        r'|(?P<raw>R"(?P<mark>[^()\s\\]{0,16})\(.*?\)(?P=mark)")'
        r'|(?P<string>"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\')',
        re.DOTALL | re.MULTILINE)

    def blank(match):
        if match.group("include"):
            return match.group()
        return re.sub(r"[^\n]", " ", match.group())

    return pattern.sub(blank, text)


def includes_of(text):
    """(line, mark, name) for each include: mark is < or "."""
    for number, line in enumerate(without_comments(text).split("\n"), 1):
        match = re.match(r'\s*#\s*include\s*([<"])([^>"]*)[>"]', line)
        if match:
            yield number, match.group(1), match.group(2).strip()


def resolve(root, path, name):
    """The project's file that an include in `path` means, relative to the root, or None."""
    for folder in [os.path.dirname(path), "src", "", "include", "tests"]:
        candidate = os.path.normpath(os.path.join(folder, name)).replace(os.sep, "/")
        if not candidate.startswith("../") and os.path.isfile(os.path.join(root, candidate)):
            return candidate
    return None


def matches(path, patterns):
    return any(fnmatch.fnmatchcase(path, pattern.split(":")[-1]) for pattern in patterns)


def check_file(root, path, only_home, report):
    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
        text = file.read()
    public = path.startswith("include/")
    room = room_of(path)
    if room is None:
        hint = ("give it one in PUBLIC of tools/check_includes.py" if public
                else "rooms are " + ", ".join(sorted(ROOMS)))
        report(path, 1, f"this file belongs to no room; {hint}")
        return
    # A part of another file, which may be included more than once with other settings, says so.
    whole = re.search(r"^#pragma once\b", text, re.MULTILINE) or re.search(r"\bIncluded by\b", text[:500])
    if path.endswith(".h") and not whole:
        report(path, 1, 'a header starts with #pragma once, or says "Included by ..." if it is a part of another file')

    for line, mark, name in includes_of(text):
        heavy = next((entry for entry in HEAVY if re.fullmatch(entry[0], name)), None)
        if heavy:
            _, product, homes = heavy
            if not matches(path, homes):
                where = ", ".join(home.replace("one:", "one file of ") for home in homes)
                report(path, line, f"<{name}> ({product}) belongs in {where} only")
            elif any(home.startswith("one:") for home in homes):
                first = only_home.setdefault(product, path)
                if first != path:
                    report(path, line, f"<{name}> ({product}) is slow to compile: one file has it, and {first} does already")
        elif mark == "<":
            if name.startswith("percale/"):
                report(path, line, f'the project\'s own headers take quotes: #include "{name}"')
            elif name in TOO_NEW:
                report(path, line, f"<{name}> is not in all compilers that build this project (g++ 12, clang 14, Emscripten)")
            elif public and name not in STANDARD:
                report(path, line, f"public headers include the standard library only, not <{name}>")
        else:
            target = resolve(root, path, name)
            if target is None:
                report(path, line, f'"{name}" is no file of the project; angle brackets are for headers from elsewhere')
                continue
            if public and not target.startswith("include/"):
                report(path, line, f'public headers include public headers only, not "{name}"')
                continue
            other = room_of(target)
            if other and other != room and other not in ROOMS[room]:
                allowed = ", ".join(ROOMS[room]) or "nothing else"
                report(path, line, f'{room} may not include {other} ("{name}"); it may include {allowed}')


def check(root):
    """The violations of a tree, as (path, line, message) in order."""
    violations = []
    only_home = {}
    for top in FOLDERS:
        for folder, subfolders, files in os.walk(os.path.join(root, top)):
            subfolders.sort()
            for file in sorted(files):
                if file.endswith(SUFFIXES):
                    path = os.path.relpath(os.path.join(folder, file), root).replace(os.sep, "/")
                    check_file(root, path, only_home, lambda *violation: violations.append(violation))
    return violations


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    root = sys.argv[1] if len(sys.argv) == 2 else os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    if not os.path.isdir(os.path.join(root, "src")):
        print(f"{root}: expected the root of the project, a folder with src/ in it", file=sys.stderr)
        return 2
    violations = check(root)
    for path, line, message in violations:
        print(f"{path}:{line}: {message}")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
