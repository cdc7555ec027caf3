#!/usr/bin/env python3
# test_live_web.py PROGRAM - live sessions in a browser; without Chromium only the server is tried.
#
# SPDX-License-Identifier: GPL-3.0-or-later
import http.client
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

import browser

PROGRAM = os.path.abspath(sys.argv[1])
SKIPPED = 77

# A gas that never rests, small enough to leave the processor to the browser.
SCENE = """
until = 1000.0; box = [0.0, 0.0, 18.0, 18.0]; model = "md";
grains = ({ radius = 0.5; restitution = 1.0; stiffness = 10000.0; });
placements = ({ kind = "square"; spacing = 1.8; temperature = 1.0; });
view = { size = (320, 240); range = (0.0, 3.0); };
"""


class Live:
    """A session with its server."""

    def __init__(self):
        with open("scene.cfg", "w") as out:
            out.write(SCENE)
        self.process = subprocess.Popen(
            [PROGRAM, "live", "scene.cfg", "--web", "-o", "run", "--force"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        parts = urllib.parse.urlparse(self.address)
        self.port, self.path = parts.port, parts.path

    def ask(self, method, path, body=None, headers=None, host=None):
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        link.putrequest(method, path, skip_host=True)
        link.putheader("Host", host or "127.0.0.1:%d" % self.port)
        for name, value in (headers or {}).items():
            link.putheader(name, value)
        if body is not None:
            link.putheader("Content-Length", str(len(body)))
        link.endheaders(body)
        answer = link.getresponse()
        data = answer.read()
        link.close()
        return answer, data

    def get(self, name):
        return self.ask("GET", self.path + name)

    def command(self, line):
        answer, data = self.ask("POST", self.path + "command", line.encode())
        assert answer.status == 200, answer.status
        return json.loads(data)

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        _, complaint = self.process.communicate(timeout=30)
        assert self.process.returncode == 143, (self.process.returncode, complaint)
        return complaint


def test_only_the_right_address_is_answered(live):
    for path in ("/", "/" + "0" * 32 + "/", live.path[:-2] + "/", live.path.upper() + "x",
                 "/../" + live.path[1:], "/frame", live.path[:-1] + "0/"):
        answer, data = live.ask("GET", path)
        assert answer.status == 403, (path, answer.status)
        assert live.path[1:-1].encode() not in data
    for host in ("evil.example", "127.0.0.1.evil.example", "127.0.0.1:80x", "10.0.0.1"):
        assert live.ask("GET", live.path, host=host)[0].status == 403, host
    assert live.ask("GET", live.path, host="localhost:9999")[0].status == 200
    for headers in ({"Origin": "http://evil.example"}, {"Origin": "null"},
                    {"Origin": "https://127.0.0.1:%d" % live.port},
                    {"Sec-Fetch-Site": "cross-site"}):
        answer, _ = live.ask("POST", live.path + "command", b"pause", headers)
        assert answer.status == 403, headers
    same = {"Origin": "http://127.0.0.1:%d" % live.port}
    assert live.ask("POST", live.path + "command", b"pause", same)[0].status == 200
    assert live.ask("PUT", live.path + "command", b"pause")[0].status == 405
    assert live.get("nothing")[0].status == 404
    # Nobody listens on other interfaces.
    listening = open("/proc/net/tcp").read().splitlines()[1:]
    local = [line.split()[1] for line in listening if line.split()[3] == "0A"]
    assert [place for place in local if place.endswith(":%04X" % live.port)] \
        == ["0100007F:%04X" % live.port]


def test_requests_are_bounded(live):
    answer, _ = live.ask("POST", live.path + "command", b"x" * 5000)
    assert answer.status == 413, answer.status
    assert live.ask("POST", live.path + "command", b"get\0time")[0].status == 400
    reply = live.command("x" * 900)
    assert not reply["ok"] and "no command" in reply["text"]
    assert not live.command("get \u00e4\n")["ok"]
    _, data = live.ask("POST", live.path + "command", b"get t\xff\xc3")
    assert not json.loads(data)["ok"] and "'t??'" in json.loads(data)["text"]
    assert live.command("")["ok"]
    # Many links that say nothing leave room for one that does.
    idle = [http.client.HTTPConnection("127.0.0.1", live.port) for _ in range(8)]
    for link in idle:
        link.connect()
    assert live.command("get time")["ok"]
    for link in idle:
        link.close()


def test_pictures_come_when_somebody_waits_and_something_has_changed(live):
    first, pixels = live.get("frame?as=raw")
    assert first.status == 200 and len(pixels) == 320 * 240 * 4
    number = int(first.headers["X-Frame"])
    png, data = live.get("frame?as=png")
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", data[16:24]) == (320, 240)
    # At rest nothing new comes ...
    answer, _ = live.get("frame?after=%d" % number)
    assert answer.status == 204 and json.loads(answer.headers["X-Status"])["running"] is False
    # ... and while it runs and nobody looks, nothing is drawn.
    live.command("go")
    time.sleep(0.5)
    answer, other = live.get("frame?as=raw&after=%d" % number)
    assert int(answer.headers["X-Frame"]) == number + 1 and other != pixels
    live.command("pause")
    status = json.loads(answer.headers["X-Status"])
    assert status["time"] > 0 and status["grains"] == 100


def steps_in(live, seconds):
    before = int(live.command("get steps")["text"])
    time.sleep(seconds)
    return int(live.command("get steps")["text"]) - before


def test_several_watch_and_a_slow_one_holds_nobody_up(live):
    # One asks for a picture after the other and never reads any: its line fills up.
    slow = socket.create_connection(("127.0.0.1", live.port))
    slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    slow.sendall(b"".join(b"GET %sframe?as=raw HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n"
                          % (live.path.encode(), live.port) for _ in range(20)))
    live.command("go")
    seen = [[], [], []]

    def watch(numbers):
        last = 0
        while len(numbers) < 8:
            answer, _ = live.get("frame?as=raw&after=%d" % last)
            if answer.status == 200:
                last = int(answer.headers["X-Frame"])
                numbers.append(last)
    watchers = [threading.Thread(target=watch, args=(numbers,)) for numbers in seen]
    for watcher in watchers:
        watcher.start()
    assert steps_in(live, 0.3) > 0
    for watcher in watchers:
        watcher.join(60)
    assert all(len(numbers) == 8 and numbers == sorted(set(numbers)) for numbers in seen), seen
    # It goes on, and commands are served, while the slow one still does not read.
    assert steps_in(live, 0.3) > 0
    live.command("pause")
    slow.close()


def test_a_saved_picture_is_what_is_seen(live):
    live.command("pause")
    live.command("frame seen")
    _, data = live.get("picture.png")
    from_server = pixels_of(data)
    saved = pixels_of(open("run/seen.png", "rb").read())
    assert from_server == saved


def pixels_of(png):
    """The compressed pixels, without the notes that only a saved file has."""
    at, data = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        data += png[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    import zlib
    return zlib.decompress(data)


def test_the_page_watches_steers_and_inspects(live):
    page = browser.Browser()
    try:
        page.go(live.address)
        page.wait("typeof shown !== 'undefined' && shown > 0 && status !== null")
        look = "Array.from(ink.getImageData(0, 0, 320, 240).data.slice(0, 307200)).join()"
        before = page.run(look)
        page.run("$('play').click()")
        page.wait("status.running && shown > 5")
        page.wait(look + " !== " + json.dumps(before))
        # The slider of the restitution changes the run.
        page.run("document.querySelectorAll('details').forEach(d => d.open = true)")
        page.wait("document.querySelector('[data-path=\"grains.[0].restitution\"]') !== null")
        page.run("(s => { s.value = 0.25; s.dispatchEvent(new Event('input')); })"
                 "(document.querySelector('[data-path=\"grains.[0].restitution\"]'))")
        page.wait("fetch('command', {method: 'POST', body: 'get grains.restitution'})"
                  ".then(a => a.json()).then(r => r.text === '0.25')")
        energy = page.run("status.kinetic_energy")
        page.wait("status.kinetic_energy < %.9g" % (0.9 * energy))
        # The colour menu changes the look, a key of the keyboard pauses.
        page.run("(s => { s.value = 'species'; s.dispatchEvent(new Event('change')); })($('color'))")
        page.wait("fetch('command', {method: 'POST', body: 'get view.color'})"
                  ".then(a => a.json()).then(r => r.text === '\"species\"')")
        page.run("document.activeElement.blur()")
        page.key(" ")
        page.wait("!status.running")
        page.wait("new Promise(done => setTimeout(done, 300)).then(() => true)")
        # A click on a grain tells about that grain.
        grain = json.loads(live.command("inspect 50")["text"])
        point = page.run("(box => [box.left + (%.9g - status.x0) * status.scale * box.width"
                         " / view.width, box.top + (status.y1 - %.9g) * status.scale * box.height"
                         " / view.height])(view.getBoundingClientRect())" % (grain["x"], grain["y"]))
        page.mouse("mousePressed", *point)
        page.mouse("mouseReleased", *point)
        page.wait("!$('tip').hidden && $('tip').querySelector('td:nth-child(2)').textContent"
                  " === '50'")
        # A drag from there pushes it along.
        page.mouse("mousePressed", *point)
        page.mouse("mouseMoved", point[0] + 40, point[1])
        page.mouse("mouseReleased", point[0] + 40, point[1])
        end = time.time() + 20
        while json.loads(live.command("inspect 50")["text"])["vx"] < grain["vx"] + 0.1:
            assert time.time() < end
            time.sleep(0.05)
        if len(sys.argv) > 2:
            page.picture(sys.argv[2])
        # Somewhere else there is nothing to see.
        page.go(live.address[:-2] + "x/")
        page.wait("document.body.textContent.includes('not for you')")
    finally:
        page.close()


def test_the_session_of_a_browser_repeats_bit_for_bit(live):
    live.command("set gravity (0, -1)")
    live.command("go")
    time.sleep(0.3)
    live.command("push 9 9 3 0")
    time.sleep(0.3)
    assert "replay run" in live.end()
    done = subprocess.run([PROGRAM, "replay", "run", "-o", "again", "--force"],
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and "same last state" in done.stderr, done.stderr
    with open("run/session.log") as a, open("again/session.log") as b:
        assert a.read() == b.read()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else None
        sys.argv[2:] = [picture] if picture else []
        os.chdir(folder)
        session = Live()
        skipped = False
        try:
            for name, test in list(globals().items()):
                if not name.startswith("test_"):
                    continue
                if name == "test_the_page_watches_steers_and_inspects" and not browser.find():
                    print("skipped", name, "- there is no chromium on the PATH")
                    skipped = True
                    continue
                test(session)
                print("ok", name, flush=True)
        finally:
            if session.process.poll() is None:
                session.process.kill()
    sys.exit(SKIPPED if skipped else 0)
