"""./run and ./test's set-up, with stand-ins for the package manager and the build: what is called
when, what is said, and what reaches the program."""

import os
import shutil
import subprocess
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Each stand-in records its call in $CALLS.
STAND_INS = {
    # Prints what is installed of the packages that are asked for, as the real one does.
    "dpkg-query": """for p in "${@:3}"; do grep -qx "$p" "$STATE/installed" && echo "$p installed" || status=1; done
exit ${status:-0}""",
    "apt-get": """echo "apt-get $*" >>"$CALLS"
case " $* " in
  *" update "*) [ -e "$STATE/offline" ] || touch "$STATE/lists"; exit 0 ;;
esac
[ -e "$STATE/lists" ] || { echo "E: Unable to locate package"; exit 100; }
[ ! -e "$STATE/offline" ] || { echo "E: Failed to fetch"; exit 100; }
for p in "$@"; do case $p in -*|install|*=*) ;; *) echo "$p" >>"$STATE/installed" ;; esac; done""",
    "id": """cat "$STATE/uid" """,
    "sudo": """[ "$1" = -n ] && { shift; [ -e "$STATE/sudoer" ] || exit 1; }
echo "sudo $*" >>"$CALLS"; exec "$@" """,
    "cmake": """echo "cmake $*" >>"$CALLS"
[ ! -e "$STATE/badcmake" ] || { echo "CMake Error: no good"; exit 1; }
mkdir -p build/release && touch build/release/build.ninja
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt""",
    "ninja": """echo "ninja $*" >>"$CALLS"
[ ! -e "$STATE/badbuild" ] || { echo "[1/2] CXX a.o"; echo "FAILED: a.o"; echo "a.cpp:1: error"; exit 1; }
[ -e "$2/bin/percale" ] && { echo "ninja: no work to do."; exit 0; }
echo "[1/2] CXX a.o"; echo "[2/2] LINK percale"; mkdir -p "$2/bin"
printf '#!/bin/bash\\npwd\\nprintf "[%%s]\\\\n" "$@"\\nexit 7\\n' >"$2/bin/percale"; chmod +x "$2/bin/percale" """,
}


class InCopy(unittest.TestCase):
    """A copy of the scripts in a folder with a space in its name, and the stand-ins."""

    def setUp(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        self.project = os.path.join(folder, "my project")
        self.state = os.path.join(folder, "state")
        self.elsewhere = os.path.join(folder, "some where")
        self.bin = os.path.join(folder, "bin")
        for path in [self.project, self.state, self.elsewhere, self.bin]:
            os.mkdir(path)
        shutil.copy(os.path.join(ROOT, "run"), self.project)
        shutil.copy(os.path.join(ROOT, "test"), self.project)
        shutil.copytree(os.path.join(ROOT, "tools"), os.path.join(self.project, "tools"))
        for name, body in STAND_INS.items():
            self.stand_in(name, body)
        self.packages = subprocess.run(["bash", "-c", f"source '{ROOT}/tools/setup.sh'; percale_packages"],
                                       capture_output=True, text=True, check=True).stdout.splitlines()
        self.write("installed", "\n".join(line.split("|")[0] for line in self.packages) + "\n")
        self.write("uid", "0\n")
        self.write("lists", "")

    def stand_in(self, name, body):
        path = os.path.join(self.bin, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/bash\n" + body + "\n")
        os.chmod(path, 0o755)

    def write(self, name, text):
        with open(os.path.join(self.state, name), "w", encoding="utf-8") as file:
            file.write(text)

    def remove(self, *names):
        for name in names:
            os.remove(os.path.join(self.state, name))

    def uninstall(self, *names):
        with open(os.path.join(self.state, "installed"), encoding="utf-8") as file:
            kept = [line for line in file.read().splitlines() if line not in names]
        self.write("installed", "\n".join(kept) + "\n")

    def run_script(self, *arguments, script="run", path=None):
        calls = os.path.join(self.state, "calls")
        self.write("calls", "")
        done = subprocess.run([os.path.join(self.project, script), *arguments], cwd=self.elsewhere,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              env={"PATH": path or self.bin + ":/usr/bin:/bin", "STATE": self.state, "CALLS": calls})
        with open(calls, encoding="utf-8") as file:
            return done.returncode, done.stdout, done.stderr, file.read().splitlines()


class Run(InCopy):
    def test_list_of_packages(self):
        for line in self.packages:
            name, kind, why = line.split("|")
            self.assertIn(kind, ["run", "video", "test"], line)
            self.assertTrue(name and why, line)

    def test_all_installed(self):
        code, out, err, calls = self.run_script("scene/a b.json", "--set", "cloth.ks=5", "")
        self.assertEqual(code, 7, err)  # the program's own exit code
        self.assertEqual(out.splitlines(), [self.elsewhere, "[scene/a b.json]", "[--set]", "[cloth.ks=5]", "[]"])
        self.assertEqual([call.split()[0] for call in calls], ["cmake", "ninja"])
        self.assertIn("percale_program", calls[1])

        started = time.monotonic()
        code, out, err, calls = self.run_script()
        self.assertLess(time.monotonic() - started, 1)
        self.assertEqual((code, err), (7, ""))
        self.assertEqual([call.split()[0] for call in calls], ["ninja"])

    def test_installs_what_is_missing_and_no_more(self):
        self.uninstall("libpng-dev", "doctest-dev", "ffmpeg")
        code, _, err, calls = self.run_script()
        self.assertEqual(code, 7, err)
        installs = [call for call in calls if call.startswith("apt-get")]
        self.assertEqual(len(installs), 1, calls)
        self.assertTrue(installs[0].endswith("install --no-install-recommends libpng-dev ffmpeg"), installs)
        self.assertIn("reads and writes pictures", err)
        # Everything is there now, but not what ./test needs besides.
        self.assertNotIn("apt-get", " ".join(self.run_script()[3]))

    def test_missing_lists_are_fetched_first(self):
        self.uninstall("g++")
        self.remove("lists")
        code, _, err, calls = self.run_script()
        self.assertEqual(code, 7, err)
        self.assertEqual(["update" in call for call in calls if call.startswith("apt-get")], [False, True, False])

    def test_no_network(self):
        self.uninstall("g++")
        self.remove("lists")
        self.write("offline", "")
        code, out, err, _ = self.run_script()
        self.assertEqual((code, out), (1, ""))
        self.assertIn("E: Unable to locate package", err)
        self.assertIn("apt-get install --no-install-recommends g++", err)

    def test_sudo_is_used(self):
        self.write("uid", "1000\n")
        self.write("sudoer", "")
        self.uninstall("cmake")
        code, _, err, calls = self.run_script()
        self.assertEqual(code, 7, err)
        self.assertTrue(any(call.startswith("sudo env DEBIAN_FRONTEND=noninteractive apt-get") for call in calls), calls)
        self.assertIn("with sudo", err)

    def test_neither_root_nor_sudo(self):
        self.write("uid", "1000\n")
        self.uninstall("cmake", "libtbb-dev")
        code, out, err, calls = self.run_script()
        self.assertEqual((code, out, calls), (1, "", []))
        self.assertIn("apt-get install --no-install-recommends cmake libtbb-dev", err)

    def test_video_can_wait(self):
        self.write("uid", "1000\n")
        self.uninstall("ffmpeg")
        code, _, err, _ = self.run_script()
        self.assertEqual(code, 7, err)
        self.assertIn("numbered pictures", err)
        self.assertEqual(self.run_script()[2], "")  # said once

    def test_failed_setup_of_the_build(self):
        self.write("badcmake", "")
        code, out, err, _ = self.run_script()
        self.assertEqual((code, out), (1, ""))
        self.assertIn("CMake Error: no good", err)
        self.remove("badcmake")
        self.assertEqual(self.run_script()[0], 7)

    def test_failed_build(self):
        self.write("badbuild", "")
        code, out, err, _ = self.run_script()
        self.assertEqual((code, out), (1, ""))
        self.assertIn("a.cpp:1: error", err)
        self.assertIn("build/release.log", err)

    def test_moved_project_is_set_up_anew(self):
        self.run_script()
        moved = self.project + " 2"
        os.rename(self.project, moved)
        self.project = moved
        code, _, err, calls = self.run_script()
        self.assertEqual(code, 7, err)
        self.assertEqual([call.split()[0] for call in calls], ["cmake", "ninja"])

    def test_system_without_apt(self):
        os.remove(os.path.join(self.bin, "dpkg-query"))
        os.remove(os.path.join(self.bin, "apt-get"))
        # The rest of the system, without its package manager and compilers.
        for tool in ["bash", "dirname", "cut", "tr", "grep", "mkdir", "cat", "rm", "touch", "getconf", "chmod", "env"]:
            os.symlink(shutil.which(tool), os.path.join(self.bin, tool))
        code, out, err, _ = self.run_script(path=self.bin)
        self.assertEqual((code, out), (1, ""))
        self.assertIn("no apt-get", err)
        self.assertIn("Missing: c++", err)
        self.stand_in("c++", "exit 0")
        code, _, err, calls = self.run_script(path=self.bin)
        self.assertEqual(code, 7, err)
        self.assertEqual([call.split()[0] for call in calls], ["cmake", "ninja"])


class Test(InCopy):
    """./test calls ctest per stage, runs all stages, and fails if one does."""

    def setUp(self):
        super().setUp()
        self.stand_in("cmake", """echo "cmake $*" >>"$CALLS"
mkdir -p "build/$2" && touch "build/$2/build.ninja"
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >"build/$2/CMakeCache.txt" """)
        self.stand_in("ninja", """echo "ninja $*" >>"$CALLS"; mkdir -p "$2/bin"
printf '#!/bin/bash\\n[ ! -e "$STATE/dead" ]\\n' >"$2/bin/percale"; chmod +x "$2/bin/percale" """)
        self.stand_in("ctest", """echo "ctest $*" >>"$CALLS"
case "$2" in */"$(cat "$STATE/fails")") echo "1 tests failed"; exit 8 ;; esac; echo "100% tests passed" """)
        self.write("fails", "none\n")

    def stages(self, *arguments):
        code, out, err, calls = self.run_script(*arguments, script="test")
        return code, [call for call in calls if call.startswith("ctest")], out, err

    def test_everything(self):
        code, calls, _, err = self.stages()
        self.assertEqual(code, 0, err)
        self.assertEqual([os.path.basename(call.split(" --output")[0]) for call in calls], ["dev", "asan", "tsan"])
        self.assertEqual([line.split()[1:3] for line in err.splitlines()[-4:]],
                         [[stage, "passed"] for stage in ["dev", "asan", "tsan", "release"]])

    def test_program_that_does_not_start(self):
        self.write("dead", "")
        code, _, _, err = self.stages()
        self.assertEqual(code, 1)
        self.assertEqual(err.splitlines()[-1].split()[1:3], ["release", "FAILED"])

    def test_one_failure_fails_all_and_stops_nothing(self):
        self.write("fails", "asan\n")
        code, calls, _, err = self.stages()
        self.assertEqual((code, len(calls)), (1, 3))
        self.assertEqual([line.split()[2] for line in err.splitlines()[-4:]], ["passed", "FAILED", "passed", "passed"])

    def test_usage(self):
        code, out, _, calls = self.run_script("--help", script="test")
        self.assertEqual((code, calls), (0, []))
        self.assertIn("--coverage", out)
        code, _, err, calls = self.run_script("--fsat", script="test")
        self.assertEqual((code, calls), (2, []))
        self.assertIn("unknown argument: --fsat", err)
        self.assertEqual(self.run_script("-R", script="test")[0], 2)

    def test_selection(self):
        code, calls, _, _ = self.stages("--fast")
        self.assertEqual((code, len(calls)), (0, 1))
        self.assertTrue(calls[0].endswith("-L fast"), calls)
        code, calls, _, _ = self.stages("-R", "spr.*s", "--asan", "--", "--repeat", "until-fail:2")
        self.assertEqual((code, len(calls)), (0, 1))
        self.assertIn("asan", calls[0])
        self.assertTrue(calls[0].endswith("-R spr.*s --repeat until-fail:2"), calls)


if __name__ == "__main__":
    unittest.main()
