#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""render -d from outside: its page fetched while it renders, a tev that rebuilds the picture, how it ends.

usage: live_check.py path/to/render. Scenes use the built-in default surface, so no shader is needed.
"""

import http.client
import json
import os
import pty
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import urllib.parse

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "testsuite"))
import pictures  # noqa: E402
from render_program import RenderCase, main  # noqa: E402

TIMEOUT_S = 100  # for what should take a second: the machine may be busy


class Page:
    """What the browser's page does: asks for updates, keeps the picture."""

    def __init__(self, url):
        self.url = urllib.parse.urlsplit(url)
        self.mark = {"frame": 0, "change": 0, "status": 0}
        self.news = {}
        self.levels, self.values = {}, {}

    def get(self, name, headers=None):
        connection = http.client.HTTPConnection(self.url.hostname, self.url.port, timeout=TIMEOUT_S)
        connection.request("GET", self.url.path + name, headers=headers or {})
        reply = connection.getresponse()
        body = reply.read()
        connection.close()
        return reply.status, body

    def ask(self):
        status, body = self.get("update?page=test&" + urllib.parse.urlencode(self.mark))
        assert status == 200, status
        length, = struct.unpack_from("<I", body)
        self.news = json.loads(body[4:4 + length])
        at = 4 + length
        self.mark = {key: self.news[key] for key in self.mark}
        if self.news["restart"]:
            self.levels, self.values = {}, {}
        for x, y, w, h, _ in self.news["tiles"]:
            floats = struct.unpack_from(f"<{4 * w * h}f", body, at + 4 * w * h)
            for i in range(w * h):
                place = (x + i % w, y + i // w)
                self.levels[place] = tuple(body[at + 4 * i:at + 4 * i + 3])
                self.values[place] = floats[4 * i:4 * i + 4]
            at += 20 * w * h
        assert at == len(body)
        return self.news

    def watch(self):
        """Until the program says that nothing follows."""
        while not self.ask()["closing"]:
            pass


class Tev(threading.Thread):
    """Listens as tev does and keeps the pictures: name -> (width, height, {place: rgba})."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.images = {}
        self.start()

    def run(self):
        with self.socket, self.socket.accept()[0] as connection, connection.makefile("rb") as stream:
            while size := stream.read(4):
                self.take(stream.read(struct.unpack("<I", size)[0] - 4))

    def take(self, packet):
        def text():
            nonlocal packet
            word, _, packet = packet.partition(b"\0")
            return word.decode()

        def numbers(form):
            nonlocal packet
            values = struct.unpack_from(form, packet)
            packet = packet[struct.calcsize(form):]
            return values

        kind, _ = numbers("<BB")
        name = text()
        if kind == 4:
            width, height, count = numbers("<iii")
            assert [text() for _ in range(count)] == ["R", "G", "B", "A"]
            self.images[name] = (width, height, {})
        else:
            assert kind == 6, kind
            count, = numbers("<i")
            for _ in range(count):
                text()
            x, y, width, height = numbers("<iiii")
            assert numbers("<4q") == (0, 1, 2, 3) and numbers("<4q") == (4, 4, 4, 4)
            for i in range(width * height):
                self.images[name][2][x + i % width, y + i // width] = struct.unpack_from("<4f", packet, 16 * i)
            assert len(packet) == 16 * width * height


class Live(RenderCase):
    def setUp(self):
        super().setUp()
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait()
            for stream in (process.stdout, process.stderr):
                if stream:
                    stream.close()
        super().tearDown()

    def start(self, *arguments, **options):
        process = super().start(*arguments, **{"stdin": subprocess.DEVNULL, "stdout": None, **options})
        self.processes.append(process)
        return process

    def scene(self, name="a.tif", kind="file", mode="rgb", size=64, samples=2):
        return super().scene(name, size, samples, mode, kind)

    def url(self, stream):
        while line := stream.readline():
            if match := re.search(r"http://127\.0\.0\.1:\d+/\w+/", line):
                return match[0]
        self.fail("render printed no address")

    def end(self, process):
        """Standard error's rest; the program ends by itself."""
        messages = process.stderr.read()
        self.assertEqual(process.wait(TIMEOUT_S), 0, messages)
        return messages

    def test_page_while_it_renders(self):
        self.write("s.rib", self.scene(size=200, samples=4))
        process = self.start("-d", "8", "--display-server", "web", "-t", "1", "s.rib")
        page = Page(self.url(process.stderr))
        status, html = page.get("")
        self.assertEqual(status, 200)
        self.assertIn(b"</html>", html)
        self.assertEqual(page.get("../../../etc/passwd")[0], 404)
        self.assertEqual(page.get("", {"Host": "elsewhere.example"})[0], 403)
        while not page.levels:
            page.ask()
        self.assertEqual((page.news["width"], page.news["height"]), (200, 200))
        self.assertTrue(page.get("picture.png")[1].startswith(b"\x89PNG"))
        page.watch()
        self.assertEqual(page.news["state"], "done")
        self.end(process)
        self.compare(page.levels, "a.tif")

    def compare(self, levels, name):
        picture = pictures.read_picture(self.path(name))
        self.assertEqual(len(levels), picture.width * picture.height)
        for (x, y), shown in levels.items():
            self.assertEqual(shown, tuple(round(255 * v) for v in picture.at(x, y)), (x, y))

    def test_order_of_rows_changes_no_byte(self):
        files = []
        for arguments in ([], ["-d", "4", "-Progress"], ["-d"]):
            self.write("s.rib", self.scene())
            process = self.start(*arguments, "s.rib")
            messages = self.end(process)
            self.assertEqual("R90000 100%" in messages, "-Progress" in arguments)
            files.append(self.bytes_of("a.tif"))
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_tev_gets_the_picture(self):
        tev = Tev()
        floats = 'Quantize "rgba" 0 0 0 0\n'
        self.write("s.rib", f"FrameBegin 3\n{floats}{self.scene('a.tif', mode='rgba')}FrameEnd\n{self.scene('b.tif')}")
        process = self.start("--display-server", f"127.0.0.1:{tev.port}", "-crop", ".25", "1", "0", ".5", "s.rib")
        messages = self.end(process)
        self.assertIn("connected to tev", messages)
        self.assertNotIn("http:", messages)
        tev.join(TIMEOUT_S)
        self.assertEqual(sorted(tev.images), ["a.tif frame 3", "b.tif"])
        width, height, pixels = tev.images["a.tif frame 3"]
        self.assertEqual((width, height, len(pixels)), (48, 32, 48 * 32))
        picture = pictures.read_picture(self.path("a.tif"))
        for (x, y), rgba in pixels.items():
            self.assertEqual(rgba, tuple(picture.at(x, y)))

    def test_framebuffer_display(self):
        self.write("s.rib", self.scene("name.rib", "framebuffer"))
        messages = self.end(self.start("s.rib"))  # no terminal, no -d: nobody could look
        self.assertNotIn("http:", messages)
        self.assertIn("name.rib.tif", messages)
        self.assertTrue(os.path.exists(self.path("name.rib.tif")))
        self.write("s.rib", self.scene("window.tif", "framebuffer").replace("Proj", 'Display "+file.tif" "file" "rgb"\nProj'))
        messages = self.end(self.start("-d", "s.rib"))
        self.assertIn("http:", messages)
        self.assertFalse(os.path.exists(self.path("window.tif")))
        self.assertTrue(os.path.exists(self.path("file.tif")))

    def test_choice_by_environment(self):
        self.write("s.rib", self.scene())
        self.environment["PERIGEE_DISPLAY"] = "none"
        self.assertEqual(self.end(self.start("-d", "s.rib")), "")
        self.environment["PERIGEE_DISPLAY"] = "127.0.0.1:1"
        messages = self.end(self.start("-d", "s.rib"))
        self.assertIn("warning: no viewer at 127.0.0.1:1", messages)
        self.environment["PERIGEE_DISPLAY"] = "nonsense"
        self.assertIn("PERIGEE_DISPLAY is 'nonsense'", self.end(self.start("s.rib")))
        process = self.start("--display-server", "nonsense", "s.rib")
        process.stderr.read()
        self.assertEqual(process.wait(TIMEOUT_S), 2)

    def test_interrupt_tells_the_page(self):
        self.write("s.rib", self.scene(size=2000, samples=16))
        process = self.start("-d", "--display-server", "web", "s.rib")
        page = Page(self.url(process.stderr))
        while not page.levels:
            page.ask()
        self.assertEqual(page.news["state"], "rendering")  # it would take minutes
        self.assertLess(page.news["done"], page.news["total"])
        watcher = threading.Thread(target=page.watch)
        watcher.start()
        process.send_signal(signal.SIGINT)
        watcher.join(TIMEOUT_S)
        self.assertEqual(page.news["state"], "stopped")
        process.stderr.read()
        self.assertEqual(process.wait(TIMEOUT_S), -signal.SIGINT)

    def test_stays_on_a_terminal_until_ctrl_c(self):
        self.write("s.rib", self.scene())
        controller, terminal = pty.openpty()
        process = self.start("-d", "--display-server", "web", "s.rib", stderr=terminal)
        os.close(terminal)
        with os.fdopen(controller, encoding="utf-8", newline="") as stream:
            page = Page(self.url(stream))
            while page.news.get("state") != "done":
                page.ask()
            page.mark = {"frame": 0, "change": 0, "status": 0}  # loaded again
            page.ask()
            self.assertEqual(page.news["state"], "done")
            self.assertEqual(len(page.levels), 64 * 64)
            self.assertFalse(page.news["closing"])
            while "Ctrl-C" not in stream.readline():
                pass
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(TIMEOUT_S), 0)  # the picture was finished
        self.assertTrue(os.path.exists(self.path("a.tif")))


if __name__ == "__main__":
    main()
