# SPDX-License-Identifier: Apache-2.0
"""What the tests of the program render from outside share: a folder per test, runs, a scene.

Each test program is started with the path of render. Scenes use the built-in default surface, so no shader is needed.
"""

import os
import subprocess
import sys
import tempfile
import time
import unittest

RENDER = os.path.abspath(sys.argv.pop(1))

SCENE = """
Format {size} {size} 1
PixelSamples {samples} {samples}
Display "{name}" "{kind}" "{mode}"
Projection "perspective" "fov" [40]
WorldBegin
  Translate 0 0 5
  Color [1 .5 .2] Sphere 1 -1 1 360
  Translate .5 .5 -1 Opacity [.5 .5 .5] Sphere .5 -.5 .5 360
WorldEnd
"""


class RenderCase(unittest.TestCase):
    program = RENDER

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.environment = dict(os.environ, HOME=self.folder.name)
        for name in ("SHADERS", "TEXTURES", "ARCHIVES", "PERIGEE_CACHE", "XDG_CACHE_HOME", "BMRTHOME",
                     "PERIGEE_DISPLAY"):
            self.environment.pop(name, None)

    def tearDown(self):
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def start(self, *arguments, **options):
        options = {"cwd": self.folder.name, "env": self.environment, "stdout": subprocess.PIPE,
                   "stderr": subprocess.PIPE, "text": True, **options}
        return subprocess.Popen([self.program, *arguments], **options)

    def run_render(self, *arguments, text=None, **options):
        """Exit code, output, messages."""
        process = self.start(*arguments, stdin=subprocess.PIPE, **options)
        output, messages = process.communicate(text, timeout=100)
        return process.returncode, output, messages

    def good(self, *arguments, **options):
        """A run that must succeed; its messages."""
        code, _, messages = self.run_render(*arguments, **options)
        self.assertEqual(code, 0, messages)
        return messages

    def files(self):
        return sorted(name for name in os.listdir(self.folder.name) if not name.startswith(".cache"))

    def scene(self, name="a.tif", size=40, samples=2, mode="rgba", kind="file"):
        return SCENE.format(name=name, size=size, samples=samples, mode=mode, kind=kind)

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def wait_for(self, condition, process):
        """True when the condition holds, False when the process ended before."""
        while process.poll() is None:
            if condition():
                return True
            time.sleep(0.005)
        return False


def main():
    unittest.main(verbosity=0)
