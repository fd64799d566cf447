# SPDX-License-Identifier: Apache-2.0
"""Test of render's shader compilation from outside: several renders at once, interrupts, kill -9, packages, messages.

usage: shader_cache_check.py RENDER SLC SLCTELL
A script stands for the C compiler where the test must know what the compiler does.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RENDER, SLC, SLCTELL = (os.path.abspath(path) for path in sys.argv[1:4])
REAL_CC = shutil.which("cc") or shutil.which("gcc")
SURFACE = "surface {0}(float k = .5;) {{ Oi = Os; Ci = Os * Cs * k * diffuse(normalize(N)); }}\n"

# Notes each compilation; then is the real compiler, or never ends. It is the real preprocessor, too.
COUNTING_CC = """#!/bin/sh
case " $* " in *" -c "*) echo x >>"$CC_LOG" ;; esac
exec {cc} "$@"
"""
ENDLESS_CC = """#!/bin/sh
case " $* " in *" -c "*) ;; *) exec {cc} "$@" ;; esac
: >"$TMPDIR/half-written"
echo $$ >>"$CC_LOG"
sleep 10000 & wait
"""


def living(groups):
    """Processes of these groups, without those that are dead and only wait to be noticed."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                state, _, group = file.read().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(group) in groups and state not in "ZX":
            found.append(name)
    return found


def scene(shaders, option=""):
    calls = "".join(f'Surface "{name}" Sphere 1 -1 1 360\n' for name in shaders)
    return (f'{option}\nDisplay "out.png" "png" "rgb"\nFormat 16 16 1\nPixelSamples 1 1\nWorldBegin\n'
            f'LightSource "distantlight" 1 "to" [0 0 1]\nTranslate 0 0 5\n{calls}WorldEnd\n')


class ShaderCompilation(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        for name in ("cache", "tmp", "bin"):
            os.mkdir(self.path(name))
        self.environment = dict(os.environ, PERIGEE_CACHE=self.path("cache"), TMPDIR=self.path("tmp"), SHADERS="",
                                CC_LOG=self.path("cc.log"), PATH=self.path("bin") + ":" + os.environ["PATH"])

    def path(self, *parts):
        return os.path.join(self.folder.name, *parts)

    def write(self, name, text, mode=0o644):
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(text)
        os.chmod(self.path(name), mode)

    def compiler(self, text):
        self.write("bin/cc", text.format(cc=REAL_CC), 0o755)

    def start(self, *arguments):
        return subprocess.Popen([RENDER, "--progress=none", *arguments], cwd=self.folder.name, env=self.environment,
                                stderr=subprocess.PIPE, text=True)

    def render(self, *arguments):
        process = self.start(*arguments)
        said = process.communicate(timeout=100)[1]
        return process.returncode, said.splitlines()

    def compilations(self):
        try:
            with open(self.path("cc.log"), encoding="ascii") as file:
                return file.read().split()
        except FileNotFoundError:
            return []

    def wait_for_compiler(self):
        deadline = time.monotonic() + 60
        while not self.compilations():
            self.assertLess(time.monotonic(), deadline, "the compiler was never started")
            time.sleep(.01)

    def test_several_renders_compile_each_shader_once(self):
        names = ["a", "b", "c"]
        for name in names:
            self.write(name + ".sl", SURFACE.format(name))
        self.write("scene.rib", scene(names * 2))
        self.compiler(COUNTING_CC)
        processes = [self.start("-t", "2", "scene.rib") for _ in range(3)]
        for process in processes:
            said = process.communicate(timeout=100)[1]
            self.assertEqual((process.returncode, said), (0, ""))
        self.assertEqual(len(self.compilations()), len(names))
        left = [f for _, _, files in os.walk(self.path("cache")) for f in files if not f.endswith(".slo")]
        self.assertEqual(left, [])

    def test_interrupt_ends_the_compiler_and_leaves_nothing(self):
        self.write("a.sl", SURFACE.format("a"))
        self.write("scene.rib", scene(["a"]))
        self.compiler(ENDLESS_CC)
        process = self.start("scene.rib")
        self.wait_for_compiler()
        process.send_signal(signal.SIGTERM)
        said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, -signal.SIGTERM, said)
        self.assertNotIn("error", said)
        self.assertEqual(os.listdir(self.path("tmp")), [])
        self.assertEqual(living([int(group) for group in self.compilations()]), [])

    def test_a_killed_render_leaves_no_lock(self):
        self.write("a.sl", SURFACE.format("a"))
        self.write("scene.rib", scene(["a"]))
        self.compiler(ENDLESS_CC)
        process = self.start("scene.rib")
        self.wait_for_compiler()
        process.kill()
        process.communicate(timeout=60)
        os.killpg(int(self.compilations()[0]), signal.SIGKILL)
        os.remove(self.path("bin/cc"))
        self.assertEqual(self.render("scene.rib"), (0, []))

    def test_messages_do_not_depend_on_threads(self):
        for name in "abcdef":
            self.write(name + ".sl", SURFACE.format(name).replace("Cs", "Cs" if name in "ace" else "Cz"))
        self.write("scene.rib", scene("fabcde" + "f") .replace("WorldEnd", 'Surface "absent" Sphere 1 -1 1 360\nWorldEnd'))
        said = []
        for threads in "1", "2", "4":
            shutil.rmtree(self.path("cache"))
            said.append(self.render("-t", threads, "scene.rib"))
        self.assertEqual(said[0], said[1])
        self.assertEqual(said[0], said[2])
        self.assertEqual(said[0][0], 1)
        errors = [line for line in said[0][1] if "error" in line]
        self.assertEqual([line[:4] for line in errors[:3]], ["./f.", "./b.", "./d."], errors)
        self.assertIn('no shader "absent"', errors[3])

    def test_shaders_nobody_uses_are_not_spoken_of(self):
        self.write("bad.sl", "surface bad() { nonsense }\n")
        self.write("scene.rib", scene([]).replace("WorldEnd", 'Surface "bad" Surface "matte" Sphere 1 -1 1 360\nWorldEnd'))
        self.assertEqual(self.render("scene.rib"), (0, []))

    def test_the_path_at_the_request_counts(self):
        for folder, k in ("one", "1"), ("two", ".5"):
            os.mkdir(self.path(folder))
            self.write(folder + "/a.sl", SURFACE.format("a").replace(".5", k) )
            self.write(f"{folder}.rib", scene(["a"], f'Option "searchpath" "shader" "{folder}:&"'))
        early = scene([], 'Option "searchpath" "shader" "one:&" Surface "a" Option "searchpath" "shader" "two:@"')
        self.write("early.rib", early.replace("WorldEnd", "Sphere 1 -1 1 360\nWorldEnd"))
        pictures = []
        for name in "one", "two", "early":
            self.assertEqual(self.render("-o", name + ".png", name + ".rib"), (0, []))
            with open(self.path(name + ".png"), "rb") as file:
                pictures.append(file.read())
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_packages(self):
        for name in "a", "b":
            self.write(name + ".sl", SURFACE.format(name))
        os.mkdir(self.path("lib"))

        def slc(*arguments):
            return subprocess.run([SLC, "-q", *arguments], cwd=self.folder.name, env=self.environment, check=False,
                                  capture_output=True, text=True)

        self.assertEqual(slc("-o", "b.slo", "b.sl").returncode, 0)
        self.assertEqual(slc("-o", "lib/two.slpkg", "a.sl", "b.slo").returncode, 0)
        clash = slc("-o", "lib/clash.slpkg", "a.sl", "a.sl")
        self.assertEqual((clash.returncode, os.path.exists(self.path("lib/clash.slpkg"))), (1, False))
        for name in "a.sl", "b.sl", "b.slo":
            os.remove(self.path(name))
        told = subprocess.run([SLCTELL, "--list", "lib/two.slpkg"], cwd=self.folder.name, capture_output=True, text=True,
                              check=False)
        self.assertEqual((told.returncode, told.stdout), (0, "surface a\nsurface b\n"))
        self.write("scene.rib", scene(["a", "b"]))
        self.write("path.rib", scene(["a", "b"], 'Option "searchpath" "shader" "lib/two.slpkg:&"'))
        self.assertEqual(self.render("-shaders", "lib/two.slpkg", "scene.rib"), (0, []))
        self.environment["SHADERS"] = "lib/two.slpkg"
        self.assertEqual(self.render("scene.rib"), (0, []))
        self.assertEqual(self.render("path.rib"), (0, []))
        self.environment["SHADERS"] = ""
        code, said = self.render("path.rib")
        self.assertEqual(code, 1)
        self.assertTrue(any("is not loaded" in line for line in said), said)
        self.assertEqual(self.render("--allow-programs", "path.rib"), (0, []))

    def test_the_size_of_the_cache(self):
        self.write("a.sl", SURFACE.format("a"))
        self.write("scene.rib", scene(["a"]))
        self.environment["PERIGEE_CACHE_SIZE"] = "0"
        self.assertEqual(self.render("scene.rib"), (0, []))
        self.assertEqual(os.listdir(self.path("cache")), [])
        self.environment["PERIGEE_CACHE_SIZE"] = "much"
        code, said = self.render("scene.rib")
        self.assertEqual((code, len(said)), (0, 1))
        self.assertIn("PERIGEE_CACHE_SIZE", said[0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=0)
