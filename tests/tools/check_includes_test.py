"""The include checker: a good tree passes, each kind of violation is reported where it stands."""

import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CHECKER = os.path.join(ROOT, "tools", "check_includes.py")

GOOD = {
    "include/percale/diagnostic.h": "#pragma once\n#include <string>\n",
    "include/percale/vec3.h": "#pragma once\n#include <cmath>\n",
    "include/percale/world.h": '#pragma once\n#include <span>\n#include "percale/vec3.h"\n',
    "src/core/executor.h": "#pragma once\n#include <memory>\n",
    "src/core/executor.cpp": '#include "core/executor.h"\n#include <tbb/parallel_for.h>\n',
    "src/math/eigen.h": '#pragma once\n#include "core/executor.h"\n',
    "src/springs/engine.h": '#pragma once\n#include "math/eigen.h"\n',
    "src/springs/engine.cpp": '#include "engine.h"\n',
    "src/world/world.cpp": '#include "percale/world.h"\n#include "springs/engine.h"\n',
    "io/file.h": '#pragma once\n#include "percale/world.h"\n',
    "io/file.cpp": '#include "io/file.h"\n#include <nlohmann/json.hpp>\n',
    "render/device.h": '#pragma once\n#include "io/file.h"\n',
    "render/device.cpp": '#include "render/device.h"\n#include <epoxy/gl.h>\n#include <png.h>\n',
    "apps/cli/options.cpp": "#include <CLI/CLI.hpp>\n#include <CLI/Error.hpp>\n",
    "apps/viewer/panel.cpp": '#include <imgui.h>\n#include <GLFW/glfw3.h>\n#include "render/device.h"\n',
    "tests/core/core_test.cpp": '#include <doctest/doctest.h>\n#include "render/device.h"\n#include "io/file.h"\n',
}


def run(tree):
    """The checker's exit code and lines over a tree given as path -> text."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in tree.items():
            os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
            with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([sys.executable, "-B", CHECKER, root], capture_output=True, text=True)
    return done.returncode, done.stdout.splitlines()


class CheckIncludes(unittest.TestCase):
    def expect(self, path, text, *parts):
        """A good tree with this file added or replaced has one violation, at the last line of the file."""
        code, lines = run({**GOOD, path: text})
        self.assertEqual(code, 1, lines)
        self.assertEqual(len(lines), 1, lines)
        line = text.rstrip("\n").count("\n") + 1
        self.assertTrue(lines[0].startswith(f"{path}:{line}: "), lines)
        for part in parts:
            self.assertIn(part, lines[0])

    def test_good_tree_passes(self):
        self.assertEqual(run(GOOD), (0, []))

    def test_direction(self):
        once = "#pragma once\n"
        self.expect("src/core/a.h", once + '#include "math/eigen.h"\n', "core may not include math")
        self.expect("src/math/a.h", once + '#include "springs/engine.h"\n', "math may not include springs")
        self.expect("src/springs/a.cpp", '#include "percale/world.h"\n', "springs may not include world")
        self.expect("src/fabric/a.cpp", '#include "springs/engine.h"\n', "fabric may not include springs")
        self.expect("src/world/a.cpp", '#include "io/file.h"\n', "world may not include io")
        self.expect("io/a.cpp", '#include "render/device.h"\n', "io may not include render")
        self.expect("io/a.cpp", '#include "springs/engine.h"\n', "io may not include springs")
        self.expect("render/a.cpp", '#include "../apps/viewer/panel.cpp"\n', "render may not include apps")
        self.expect("apps/cli/a.cpp", '#include "tests/core/core_test.cpp"\n', "apps may not include tests")
        self.expect("include/percale/vec3.h", once + '#include "percale/world.h"\n', "math may not include world")

    def test_relative_include_is_resolved(self):
        self.expect("src/core/a.cpp", '#include "../springs/engine.h"\n', "core may not include springs")

    def test_public_headers(self):
        once = "#pragma once\n"
        self.expect("include/percale/vec3.h", once + "#include <unistd.h>\n", "standard library only", "<unistd.h>")
        self.expect("include/percale/vec3.h", once + '#include "core/executor.h"\n', "public headers only")
        code, lines = run({**GOOD, "include/percale/new.h": once})
        self.assertEqual((code, len(lines)), (1, 1), lines)
        self.assertTrue(lines[0].startswith("include/percale/new.h:1: "), lines)

    def test_heavy_headers(self):
        self.expect("src/world/a.cpp", "#include <vector>\n#include <nlohmann/json.hpp>\n", "io/*.cpp only")
        self.expect("io/a.h", "#pragma once\n#include <nlohmann/json_fwd.hpp>\n", "io/*.cpp only")
        self.expect("apps/viewer/a.cpp", "#include <CLI/CLI.hpp>\n", "one file of apps/cli")
        self.expect("apps/cli/verb.cpp", "#include <CLI/CLI.hpp>\n", "apps/cli/options.cpp does already")
        self.expect("src/springs/a.cpp", "#include <tbb/task_arena.h>\n", "src/core/executor.cpp only")
        self.expect("src/springs/a.cpp", "#include <oneapi/tbb/task_arena.h>\n", "src/core/executor.cpp only")
        self.expect("render/a.h", "#pragma once\n#include <epoxy/gl.h>\n", "render/*.cpp")
        self.expect("io/a.cpp", "#include <GL/gl.h>\n", "OpenGL")
        self.expect("apps/cli/a.cpp", "#include <GLFW/glfw3.h>\n", "GLFW")
        self.expect("render/a.cpp", "#include <imgui.h>\n", "apps/viewer/* only")
        self.expect("apps/cli/a.cpp", "#include <imgui_impl_glfw.h>\n", "apps/viewer/* only")
        self.expect("apps/cli/a.cpp", "#include <png.h>\n", "render/*.cpp only")
        self.expect("src/core/a.cpp", '#include "doctest/doctest.h"\n', "tests/* only")

    def test_other_mistakes(self):
        self.expect("src/core/a.cpp", '#include "nowhere.h"\n', "no file of the project")
        self.expect("src/world/a.cpp", "#include <percale/world.h>\n", "take quotes")
        self.expect("src/core/a.cpp", "#include <format>\n", "not in all compilers")
        self.expect("src/core/a.h", "#include <vector>\n", "#pragma once")
        self.assertEqual(run({**GOOD, "src/core/a.h": "// Included by executor.cpp.\n"}), (0, []))
        self.expect("src/cloth/a.cpp", "int x;\n", "no room")

    def test_comments_and_strings_do_not_count(self):
        text = ('// #include "io/file.h"\n/*\n#include "io/file.h"\n*/\nconst char* s = R"(\n#include "io/file.h"\n)";\n'
                'const char* t = "/*"; const char q = \'"\';\n#include "io/file.h"\n')
        self.expect("src/core/a.cpp", text, "core may not include io")

    def test_every_violation_is_reported(self):
        code, lines = run({**GOOD, "src/core/a.cpp": '#include "io/file.h"\n#include <png.h>\n#include "springs/engine.h"\n'})
        self.assertEqual(code, 1)
        self.assertEqual([line.split(" ")[0] for line in lines],
                         ["src/core/a.cpp:1:", "src/core/a.cpp:2:", "src/core/a.cpp:3:"])

    def test_usage(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(subprocess.run([sys.executable, "-B", CHECKER, empty], capture_output=True).returncode, 2)
        self.assertEqual(subprocess.run([sys.executable, "-B", CHECKER, "--what"], capture_output=True).returncode, 2)


if __name__ == "__main__":
    unittest.main()
