#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page of render -d in a real browser: it refreshes itself, and its last picture is the file's.

usage: browser_check.py RENDER [--keep FOLDER]
Drives Debian's chromium through its debugging pipe: a screenshot, a later one while the same frame renders, one at
the end. The renderer is stopped while a screenshot is taken, so nothing depends on speed. Exit status 77 where there
is no chromium. --keep leaves the screenshots in FOLDER.
"""

import argparse
import base64
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import pictures

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TIMEOUT_S = 250
WINDOW = "1040,660"


class Browser:
    """chromium without a window; commands and answers are JSON ended by a zero byte, on descriptors 3 and 4."""

    def __init__(self, program, folder):
        commands, self.write_to = os.pipe()
        self.read_from, answers = os.pipe()
        # The shell puts the two descriptors where chromium looks for them.
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec "$@" 3<&{commands} 4>&{answers}', "sh", program, "--headless", "--no-sandbox",
             "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions", "--disable-dev-shm-usage",
             f"--window-size={WINDOW}", f"--user-data-dir={folder}/profile", "--remote-debugging-pipe", "about:blank"],
            pass_fds=(commands, answers), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env=dict(os.environ, HOME=folder))
        os.close(commands)
        os.close(answers)
        self.rest, self.number, self.session = b"", 0, None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Page.enable")

    def message(self):
        while b"\0" not in self.rest:
            block = os.read(self.read_from, 1 << 16)
            if not block:
                raise SystemExit("chromium ended")
            self.rest += block
        text, _, self.rest = self.rest.partition(b"\0")
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.write_to, json.dumps(command).encode() + b"\0")
        while (answer := self.message()).get("id") != self.number:
            pass
        if "error" in answer:
            raise SystemExit(f"{method}: {answer['error']}")
        return answer["result"]

    def value(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in result:
            raise SystemExit(f"the page's script failed: {result['exceptionDetails']}")
        return result["result"].get("value")

    def screenshot(self):
        # Two frames later everything that was taken is drawn.
        self.call("Runtime.evaluate", awaitPromise=True,
                  expression="new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))")
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.write_to)
        os.close(self.read_from)


def wait_for(what, condition):
    limit = time.monotonic() + TIMEOUT_S
    while not condition():
        if time.monotonic() > limit:
            raise SystemExit(f"not seen in {TIMEOUT_S} s: {what}")
        time.sleep(0.02)


def scene():
    """The example, smaller; it takes long enough to be looked at while it renders."""
    with open(os.path.join(ROOT, "examples", "still_life.rib"), encoding="utf-8") as file:
        text = file.read()
    return text.replace("Format 720 480", "Format 600 400")


class Check:
    def __init__(self, render, folder):
        self.folder = folder
        with open(os.path.join(folder, "still_life.rib"), "w", encoding="utf-8") as file:
            file.write(scene())
        self.browser = Browser(shutil.which("chromium"), folder)
        self.process = subprocess.Popen(
            [render, "-d", "8", "--display-server", "web", "-t", "1", "-shaders", os.path.join(ROOT, "examples"),
             "still_life.rib"], cwd=folder, env=dict(os.environ, HOME=folder), stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True)

    def url(self):
        for line in self.process.stderr:
            if match := re.search(r"http://\S+", line):
                return match[0]
        raise SystemExit("render printed no address")

    def percent(self):
        return int(self.browser.value("document.body?.dataset.percent || 0"))

    def state(self):
        return self.browser.value("document.body?.dataset.state")

    def frozen(self):
        """A screenshot while the renderer stands still, and how far it was."""
        os.kill(self.process.pid, signal.SIGSTOP)
        shot, percent, state = self.browser.screenshot(), self.percent(), self.state()
        os.kill(self.process.pid, signal.SIGCONT)
        return shot, percent, state

    def keep(self, name, shot):
        with open(os.path.join(self.folder, f"{name}.png"), "wb") as file:
            file.write(shot)

    def run(self):
        self.browser.call("Page.navigate", url=self.url())
        shots = {}
        for name, least in (("early", 5), ("late", 45)):
            wait_for(f"{least} %", lambda: self.percent() >= least)
            shots[name], percent, state = self.frozen()
            self.keep(name, shots[name])
            print(f"{name}: {state}, {percent} %")
            if state != "rendering":
                raise SystemExit("the frame was finished before the page was looked at")
        wait_for("the end", lambda: self.state() == "done")
        self.point_at(310, 250)
        shots["end"] = self.browser.screenshot()
        self.keep("end", shots["end"])
        if len(set(shots.values())) != len(shots):
            raise SystemExit("the page did not refresh itself")
        self.compare()
        messages = self.process.stderr.read()
        if self.process.wait(TIMEOUT_S) != 0:
            raise SystemExit(f"render failed:\n{messages}")
        wait_for("the page's last words", lambda: "render has ended" in self.browser.value("$('state').textContent"))
        if self.browser.screenshot() == shots["early"] or not self.canvas():
            raise SystemExit("the page lost its picture")

    def canvas(self):
        """The page's picture, R G B A a pixel."""
        return base64.b64decode(self.browser.value(
            "{ const d = bench2d.getImageData(0, 0, bench.width, bench.height).data; let s = '';"
            " for (let i = 0; i < d.length; i += 8192) s += String.fromCharCode(...d.subarray(i, i + 8192)); btoa(s) }"))

    def point_at(self, x, y):
        """The pointer over a pixel of the picture."""
        place = self.browser.value(f"{{ const r = view.getBoundingClientRect(); [r.x + (left + ({x} + .5) * zoom) / ratio(),"
                                   f" r.y + (top_ + ({y} + .5) * zoom) / ratio()] }}")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])

    def exposed(self, stops):
        self.browser.value(f"$('stops').value = {stops}; $('stops').oninput()")
        return self.canvas()

    def compare(self):
        path = os.path.join(self.folder, "still_life.png")
        wait_for("the file", lambda: os.path.exists(path))
        picture, shown = pictures.read_picture(path), self.canvas()
        expected = bytes(level for row in picture.rows for i in range(0, len(row), 3)
                         for level in (*(round(255 * v) for v in row[i:i + 3]), 255))
        if shown != expected:
            raise SystemExit("the page does not show what is in the file")
        told = self.browser.value("$('pixel').textContent")
        levels = [round(255 * v) for v in picture.at(310, 250)]
        if not told.startswith("x 310  y 250 ") or re.findall(r"\((\d+)\)", told)[:3] != list(map(str, levels)):
            raise SystemExit(f"the pixel below the pointer is {levels}, the page says: {told}")
        color = lambda rgba: sum(rgba) - sum(rgba[3::4])
        gain = color(self.exposed(1)) / color(expected)  # the scene has gamma 2.2, and whites that stay white
        if not 1.2 < gain < 2 ** (1 / 2.2) + .01 or self.exposed(0) != expected:
            raise SystemExit(f"the exposure slider does not work: one stop makes the picture {gain} times as bright")
        print(f"the page shows the {picture.width} x {picture.height} pixels of the file")

    def close(self):
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGCONT)
            self.process.kill()
        self.process.wait()
        self.process.stderr.close()
        self.browser.close()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("render")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    if shutil.which("chromium") is None:
        print("skipped: chromium is not installed (it is not among scripts/packages.txt)")
        return 77
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        check = Check(os.path.abspath(arguments.render), folder)
        try:
            check.run()
        finally:
            check.close()
            if arguments.keep:
                os.makedirs(arguments.keep, exist_ok=True)
                for name in ("early", "late", "end"):
                    if os.path.exists(os.path.join(folder, f"{name}.png")):
                        shutil.copy(os.path.join(folder, f"{name}.png"), arguments.keep)
    return 0


if __name__ == "__main__":
    sys.exit(main())
