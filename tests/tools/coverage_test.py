"""The coverage report counts the lines that ran, over several programs, per folder."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
REPORT = os.path.join(ROOT, "tools", "coverage.py")

# Three lines with code in each function, and two that depend on the argument.
SIGN = """int Sign(int x) {
  if (x < 0)
    return -1;
  return 1;
}
"""
MAIN = """int Sign(int x);
int main(int argc, char**) {
  return Sign(2 - argc) > 0 ? 0 : 1;
}
"""


@unittest.skipUnless(shutil.which("gcov") and shutil.which("g++"), "needs g++ and gcov")
class Coverage(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in {"src/core/sign.cpp": SIGN, "apps/cli/main.cpp": MAIN}.items():
            os.makedirs(os.path.dirname(os.path.join(self.root, path)))
            with open(os.path.join(self.root, path), "w", encoding="utf-8") as file:
                file.write(text)
        self.build = os.path.join(self.root, "build")
        os.mkdir(self.build)
        for source in ["src/core/sign.cpp", "apps/cli/main.cpp"]:
            target = os.path.join(self.build, os.path.basename(source) + ".o")
            subprocess.run(["g++", "-O0", "--coverage", "-c", os.path.join(self.root, source), "-o", target], check=True)
        subprocess.run(["g++", "--coverage", "sign.cpp.o", "main.cpp.o", "-o", "program"], cwd=self.build, check=True)

    def report(self):
        done = subprocess.run([sys.executable, "-B", REPORT, self.root, self.build], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def rows(self):
        code, out, err = self.report()
        self.assertEqual(code, 0, err)
        return {line.split()[0]: line.split()[1:] for line in out.splitlines()[1:-1]}

    def test_counts(self):
        code, _, err = self.report()
        self.assertEqual(code, 1, "nothing has run")
        self.assertIn("PERCALE_COVERAGE", err)

        subprocess.run([os.path.join(self.build, "program")], check=True)
        rows = self.rows()
        self.assertEqual(rows["src/core"], ["4", "3", "75.0"])
        self.assertEqual(rows["apps/cli"], ["2", "2", "100.0"])
        self.assertEqual(rows["all"], ["6", "5", "83.3"])
        with open(os.path.join(self.build, "report.html"), encoding="utf-8") as file:
            self.assertIn("<td>src/core/sign.cpp<td>4<td>75.0<td>3<", file.read())

        # A second run takes the other way; together they have run every line.
        subprocess.run([os.path.join(self.build, "program"), "a", "b"])
        self.assertEqual(self.rows()["src/core"], ["4", "4", "100.0"])


if __name__ == "__main__":
    unittest.main()
