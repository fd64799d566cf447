#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bad weather: full disks, closed streams, missing things. Each time a message, an exit code, and no damaged or
temporary file beside a final name.

usage: bad_weather_check.py path/to/render. What a machine does not allow (mounts, other users) is skipped with the reason.
"""

import os
import resource
import shutil
import signal
import subprocess
import tempfile

import render_program
from render_program import RenderCase, main

NOBODY = 65534
BUILD = os.path.dirname(os.path.dirname(render_program.RENDER))


def program(name):
    """slc of the build tree, or beside an installed render."""
    for path in (os.path.join(BUILD, "slc", name), os.path.join(os.path.dirname(render_program.RENDER), name)):
        if os.access(path, os.X_OK):
            return path
    return None


class Weather(RenderCase):
    OLD = b"an older picture"

    def old_picture(self, name="a.tif"):
        with open(self.path(name), "wb") as file:
            file.write(self.OLD)

    def fails(self, code, text, *arguments, **options):
        """A run that must fail with this code and a message that contains the text."""
        found, _, messages = self.run_render(*arguments, **options)
        self.assertEqual(found, code, messages)
        self.assertIn(text, messages)
        return messages


class Disks(Weather):
    def full_disk(self, kilobytes):
        """A file system of that size, or a skip."""
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", folder],
                                 check=False, capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("no right to mount a small file system")
        self.addCleanup(subprocess.run, ["umount", "-l", folder], check=False)
        return folder

    def test_full(self):
        disk = self.full_disk(64)
        for end in ("tif", "png", "exr"):
            # Noise does not compress: more than the disk holds.
            self.write("s.rib", self.scene(f"{disk}/a.{end}", size=200, samples=1).replace(
                "Projection", 'Quantize "rgba" 65535 0 65535 30000 Projection'))
            with open(f"{disk}/a.{end}", "wb") as file:
                file.write(self.OLD)
            if end == "exr":
                with open(f"{disk}/fill", "wb") as file:
                    file.write(bytes(56 * 1024))
            self.fails(3, "No space left", "s.rib")
            with open(f"{disk}/a.{end}", "rb") as file:
                self.assertEqual(file.read(), self.OLD)
            os.remove(f"{disk}/a.{end}")
            self.assertLessEqual(set(os.listdir(disk)), {"fill"})

    def test_full_while_a_checkpoint_is_kept(self):
        disk = self.full_disk(200)
        self.write("s.rib", self.scene(size=400, samples=3))
        self.good("--no-checkpoint", "-o", "whole.tif", "s.rib")
        messages = self.good("--checkpoint", "0", "--checkpoint-dir", disk, "s.rib")
        self.assertEqual(messages.count("No space left"), 1, messages)
        self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("whole.tif"))
        self.assertEqual(os.listdir(disk), [])

    def test_full_cache(self):
        disk = self.full_disk(4)
        self.write("own.sl", "surface own() { Oi = 1; Ci = color(1, 0, 0); }")
        self.write("s.rib", self.scene(size=8).replace("WorldBegin", 'WorldBegin Surface "own"'))
        self.environment["PERIGEE_CACHE"] = disk
        code, _, messages = self.run_render("s.rib")
        self.assertIn(code, (0, 1, 3), messages)
        self.assertTrue(messages)
        left = [name for _, _, names in os.walk(disk) for name in names if name.endswith((".slo", ".tmp"))]
        self.assertEqual(left, [])
        self.environment.pop("PERIGEE_CACHE")
        self.good("--strict", "s.rib")

    def test_files_too_large(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
        for end in ("tif", "png", "exr"):
            self.old_picture("a." + end)
            self.write("s.rib", self.scene("a." + end, size=200, samples=1))
            self.fails(3, "too large", "s.rib", preexec_fn=limit)
            self.assertEqual(self.bytes_of("a." + end), self.OLD)
            os.remove(self.path("a." + end))
            self.assertEqual(self.files(), ["s.rib"])


class Places(Weather):
    def as_nobody(self):
        """A folder that the program cannot write to."""
        if os.geteuid() != 0:
            os.chmod(self.folder.name, 0o555)
            self.addCleanup(os.chmod, self.folder.name, 0o755)
            return None
        os.chmod(self.folder.name, 0o755)

        def become():
            os.setgroups([])
            os.setgid(NOBODY)
            os.setuid(NOBODY)
        try:
            subprocess.run([self.program, "--version"], check=True, capture_output=True, preexec_fn=become)
        except (OSError, subprocess.SubprocessError):
            self.skipTest("another user cannot run this build")
        return become

    def test_unwritable_directory(self):
        self.write("s.rib", self.scene())
        become = self.as_nobody()
        self.fails(3, "Permission denied", "s.rib", preexec_fn=become)
        self.assertEqual(self.files(), ["s.rib"])

    def test_unwritable_picture(self):
        self.write("s.rib", self.scene())
        self.old_picture()
        os.chmod(self.path("a.tif"), 0o444)
        become = self.as_nobody()
        self.fails(3, "a.tif", "s.rib", preexec_fn=become)
        self.assertEqual(self.bytes_of("a.tif"), self.OLD)

    def test_target_is_a_directory(self):
        os.mkdir(self.path("a.tif"))
        self.write("s.rib", self.scene())
        self.fails(3, "directory", "s.rib")
        self.assertEqual(self.files(), ["a.tif", "s.rib"])
        self.assertEqual(os.listdir(self.path("a.tif")), [])

    def test_told_before_rendering(self):
        self.write("s.rib", self.scene("no/such/a.tif", size=20000, samples=16))  # hours, if it were rendered
        self.fails(3, "not rendered", "s.rib")

    def test_read_only_cache(self):
        self.write("own.sl", "surface own() { Oi = 1; Ci = color(1, 0, 0); }")
        self.write("s.rib", self.scene(size=8).replace('"file"', '"null"').replace("WorldBegin", 'WorldBegin Surface "own"'))
        become = self.as_nobody()
        self.environment["PERIGEE_CACHE"] = self.path("cache")
        messages = self.good("s.rib", preexec_fn=become)
        self.assertIn("cache", messages)

    def test_no_home(self):
        self.write("own.sl", "surface own() { Oi = 1; Ci = color(1, 0, 0); }")
        self.write("s.rib", self.scene().replace("WorldBegin", 'WorldBegin Surface "own"'))
        self.environment.pop("HOME")
        self.good("--strict", "s.rib")
        self.assertEqual(self.files(), ["a.tif", "own.sl", "s.rib"])


class Input(Weather):
    def test_missing_archive(self):
        self.write("s.rib", self.scene().replace("Translate 0", 'ReadArchive "nowhere.rib" Translate 0'))
        self.fails(1, "nowhere.rib", "s.rib")
        self.assertIn("a.tif", self.files())

    def test_archive_that_reads_itself(self):
        self.write("round.rib", 'ReadArchive "trip.rib"\nSphere 1 -1 1 360\n')
        self.write("trip.rib", 'ReadArchive "round.rib"\n')
        self.write("s.rib", self.scene().replace("Translate 0", 'ReadArchive "round.rib" Translate 0'))
        self.fails(1, "reads itself", "s.rib")
        self.assertIn("a.tif", self.files())

    def test_missing_file(self):
        self.write("s.rib", self.scene())
        self.fails(3, "nowhere.rib", "nowhere.rib", "s.rib")
        self.assertIn("a.tif", self.files())

    def test_directory_as_input(self):
        os.mkdir(self.path("folder.rib"))
        self.fails(3, "folder.rib", "folder.rib")

    def test_missing_texture_source(self):
        self.write("s.rib", 'MakeTexture "nowhere.tif" "t.tex" "periodic" "periodic" "box" 1 1\n' + self.scene())
        self.fails(1, "nowhere.tif", "s.rib")
        self.assertNotIn("t.tex", self.files())

    def test_corrupt_tiles(self):
        """Damage anywhere in a picture that is read never crashes and never leaves half a file."""
        for end in ("tif", "png", "exr"):
            self.write("s.rib", self.scene(size=30))
            self.good("-o", "t." + end, "s.rib")
            whole = self.bytes_of("t." + end)
            for at in range(0, len(whole), max(1, len(whole) // 25)):
                for damaged in (whole[:at], whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1:]):
                    with open(self.path("bad." + end), "wb") as file:
                        file.write(damaged)
                    code, _, messages = self.run_render("--merge", "-o", "out." + end, "bad." + end)
                    self.assertIn(code, (0, 1), messages)
                    self.assertEqual(code == 0, os.path.exists(self.path("out." + end)), messages)
                    if code == 0:
                        os.remove(self.path("out." + end))
                    else:
                        self.assertIn("bad." + end, messages)
            self.assertEqual([name for name in self.files() if name.endswith(".tmp")], [])

    def test_picture_beyond_memory(self):
        self.write("s.rib", self.scene(size=60000))
        self.fails(3, "not enough memory", "s.rib")
        self.assertEqual(self.files(), ["s.rib"])

    def test_memory_that_is_not_given(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        self.write("s.rib", self.scene(size=12000))
        self.fails(3, "not enough memory", "-t", "1", "s.rib", preexec_fn=limit)
        self.assertEqual(self.files(), ["s.rib"])


class Streams(Weather):
    def setUp(self):
        super().setUp()
        self.write("s.rib", 'Option "nonsense" "uniform float x" [1]\n' + self.scene(size=200))
        self.good("-o", "whole.tif", "s.rib")

    def test_readers_that_went_away(self):
        for mode in ("-Progress", "--progress=bar", "--stats"):
            read, write = os.pipe()
            os.close(read)
            code = subprocess.run([self.program, mode, "s.rib"], cwd=self.folder.name, env=self.environment,
                                  stdout=write, stderr=write, check=False).returncode
            os.close(write)
            self.assertEqual(code, 0)
            self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("whole.tif"))

    def test_streams_that_were_never_open(self):
        for streams in ((0,), (1,), (2,), (0, 1, 2)):
            def close(streams=streams):
                for stream in streams:
                    os.close(stream)
            code = subprocess.run([self.program, "--stats", "s.rib"], cwd=self.folder.name, env=self.environment,
                                  preexec_fn=close, check=False).returncode
            self.assertEqual(code, 0)
            self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("whole.tif"), "messages went elsewhere")

    def test_signal_while_input_is_awaited(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            read, write = os.pipe()
            process = self.start("-v", "-", stdin=read)
            self.assertIn("reading", process.stderr.readline())
            process.send_signal(stop)
            process.communicate(timeout=100)
            self.assertEqual(process.returncode, -stop)
            os.close(read)
            os.close(write)


class Compilers(Weather):
    def setUp(self):
        super().setUp()
        self.write("own.sl", "surface own() { Oi = 1; Ci = color(1, 0, 0); }")
        self.write("s.rib", self.scene().replace("WorldBegin", 'WorldBegin Surface "own"'))
        os.mkdir(self.path("empty"))

    def without_compiler(self):
        self.environment["PATH"] = self.path("empty")

    def test_sources_without_a_compiler(self):
        self.without_compiler()
        messages = self.fails(3, "compile", "s.rib")
        self.assertRegex(messages, "(?i)compiler|gcc|cc")

    def test_compiled_shaders_need_none(self):
        slc = program("slc")
        if slc is None:
            self.skipTest("slc is not built")
        subprocess.run([slc, "-o", "own.slo", "own.sl"], cwd=self.folder.name, check=True, capture_output=True)
        self.good("-o", "with.tif", "s.rib")
        self.without_compiler()
        self.good("--strict", "s.rib")
        self.assertEqual(self.bytes_of("a.tif"), self.bytes_of("with.tif"))


if __name__ == "__main__":
    main()
