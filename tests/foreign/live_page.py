#!/usr/bin/env python3
"""Operates the live page in a real browser without a screen, by roles and texts.

    python3 tests/foreign/live_page.py --opennck PROGRAM [--keep DIRECTORY] [--pictures DIRECTORY]

Playwright drives the system's Chromium (`apt-get install chromium`); axe-core checks accessibility. Both are installed into the folder
of the foreign clients. The exit code is 1 if a check failed, 3 if Playwright or the browser is not available.
"""

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
REQUIREMENTS = HERE / "requirements-live-page.txt"
VIEWS = ["Axes", "Keys", "Flowchart", "Signals", "Diagram", "Scenario"]
INSTALLING = 240
# The browser must neither ask nor fetch anything.
QUIET = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync"]

SCENARIO = """title   = "Texts with letters of HTML"
machine = {machine!r}
plc     = "enable_all"
limit   = "1h"

[[step]]
note = "<b>bold</b> <img src=x onerror=alert(1)>"
run  = "1s"
[[step]]
note = "the second step"
set  = {{ "mode_group_1.mode_jog" = 1, "mode_group_1.machine_function_ref" = 1 }}
[[step]]
wait = "time > 3000"
"""


class Absent(Exception):
    """Something is not available here; the text is the reason."""


def quietly(command, **more):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=INSTALLING, **more)
    except (FileNotFoundError, subprocess.TimeoutExpired) as error:
        raise Absent(str(error)[:120]) from None
    if done.returncode != 0:
        raise Absent((done.stderr or done.stdout).strip().splitlines()[-1][:120])
    return done.stdout


def browser():
    """The path of Chromium, installed if that is possible without a prompt."""
    if not shutil.which("chromium") and os.geteuid() == 0 and shutil.which("apt-get"):
        variables = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
        quietly(["apt-get", "update"], env=variables)
        quietly(["apt-get", "install", "-y", "--no-install-recommends", "chromium", "fonts-dejavu-core"], env=variables)
    found = shutil.which("chromium")
    if not found:
        raise Absent("chromium is not installed")
    return found


def playwright(keep):
    """Installs Playwright into a folder of its own, without a browser."""
    folder = keep / "live-page"
    if not (folder / "playwright").exists():
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        quietly([*pip, "--target", str(folder), "-r", str(REQUIREMENTS)])
    sys.path.insert(0, str(folder))
    from playwright.sync_api import sync_playwright
    return sync_playwright


def axe(keep):
    """The text of axe-core; None if there is no npm."""
    folder = keep / "live-page-axe"
    script = folder / "node_modules" / "axe-core" / "axe.min.js"
    try:
        if not script.exists():
            folder.mkdir(parents=True, exist_ok=True)
            shutil.copy(HERE / "live_page" / "package.json", folder)
            quietly(["npm", "install", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=folder)
    except Absent as absent:
        print(f"axe-core  absent: {absent}")
        return None
    return script.read_text()


class Server:
    """`opennck serve` with its page."""

    def __init__(self, program, *arguments, port=0):
        command = [program, "serve", *arguments, "--s7", "127.0.0.1:0", "--web", f"127.0.0.1:{port}"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.port = None
        for line in self.process.stdout:
            found = re.search(r"page on http://127\.0\.0\.1:(\d+)", line)
            self.port = int(found[1]) if found else self.port
            if "Ctrl-C" in line:
                return
        raise SystemExit(f"{program} serve ended before it printed its address")

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}"

    def end(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        self.process.wait(20)


class Checks:
    def __init__(self):
        self.count, self.failed = 0, 0

    def that(self, what, holds, more=""):
        self.count += 1
        if not holds:
            self.failed += 1
            print(f"-- {what}: FAILED {more}", flush=True)


def operate(chromium, program, axe_core, pictures, checks, expect):
    machine = str(PROJECT / "machine_data" / "g1_example")
    server = Server(program, machine, "--plc", "enable_all")
    foreign, errors = [], []

    def tab(width=1400, height=900):
        page = chromium.new_context(viewport={"width": width, "height": height}).new_page()
        page.on("request", lambda request: request.url.startswith(("http://127.0.0.1:", "data:")) or foreign.append(request.url))
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(server.address)
        expect(page.locator("#link")).to_have_text("live", timeout=10_000)
        return page

    def view(page, name):
        page.get_by_role("navigation").get_by_role("link", name=name, exact=True).click()

    def picture(page, name):
        if pictures:
            pictures.mkdir(parents=True, exist_ok=True)
            page.screenshot(path=str(pictures / f"{name}.png"))

    def seen(what, locator, text, timeout=20_000):
        try:
            expect(locator).to_contain_text(text, timeout=timeout)
            checks.that(what, True)
        except AssertionError as error:
            checks.that(what, False, str(error)[:300])

    def no_alarm(what, page):
        """Neither shown nor told: the text "none" is in the page even while it is hidden."""
        try:
            expect(page.locator("#alarms .alarms li")).to_have_count(0, timeout=10_000)
            expect(page.get_by_role("alert")).to_have_text("", timeout=5_000)
            checks.that(what, True)
        except AssertionError as error:
            checks.that(what, False, str(error)[:300])

    def status(page, name):
        return page.locator("#status > div", has_text=name).locator("dd")

    def seconds(page):
        return float(status(page, "Time").inner_text().split()[0])

    page = tab()
    second = tab(390, 800)
    seen("the machine is named", page.get_by_role("heading", level=1), "g1_example")

    # A key presses as long as the pointer does; REF is selected, X is referenced, and the flowchart follows.
    view(page, "Flowchart")
    seen("the phase at the start", page.locator(".phase-now"), "Now: not synchronised")
    seen("what it waits for", page.locator("#charts"), "mode_group_1.machine_function_ref")
    page.get_by_role("button", name="REF", exact=False).first.click()
    seen("REF is active", status(page, "Mode"), "REF")
    page.get_by_role("button", name=re.compile(r"^X \+")).click()
    seen("section 1", page.locator(".phase-now"), "section 1")
    picture(page, "flowchart")
    page.get_by_label("Speed").select_option("10")
    seen("section 3 waits", page.locator(".phase-now"), "section 3: waiting for the start", 60_000)
    seen("for the start", page.locator("#charts"), "X.start_gantry_synchronization")
    page.get_by_role("button", name=re.compile(r"^Start synchronization X")).click()
    seen("synchronised in the end", page.locator(".phase-now"), "Now: synchronised", 60_000)
    seen("the second tab sees it", second.locator("#axes"), "referenced 1")
    page.get_by_label("Speed").select_option("1")

    # The keyboard presses as well.
    key = page.get_by_role("button", name=re.compile(r"^RESET"))
    key.focus()
    page.keyboard.down(" ")
    checks.that("space presses a key", key.get_attribute("aria-pressed") == "true")
    page.keyboard.up(" ")
    expect(key).to_have_attribute("aria-pressed", "false", timeout=10_000)

    # A page that is left releases its keys, and so does the server when a stream ends.
    def value(name):
        at = [signal["symbol"] for signal in page.request.get(f"{server.address}/api/catalogue").json()["signals"]].index(name)
        return page.request.get(f"{server.address}/api/state").json()["values"][at]

    leaver = tab()
    leaver.get_by_role("button", name=re.compile(r"^X \+")).hover()
    leaver.mouse.down()
    leaver.wait_for_timeout(500)
    checks.that("a key is held", value("X.traversing_key_plus") == 1)
    leaver.close()
    page.wait_for_timeout(1500)
    checks.that("a page that is left releases it", value("X.traversing_key_plus") == 0)

    # Emergency stop: off, acknowledged, RESET.
    page.get_by_role("button", name=re.compile("^EMERGENCY STOP")).click()
    seen("the emergency stop has its alarm", page.locator("#alarms"), "3000")
    page.get_by_role("button", name=re.compile("^EMERGENCY STOP")).click()
    seen("what to do", page.locator("#keys"), "ACKNOWLEDGE, then RESET")
    page.get_by_role("button", name="ACKNOWLEDGE").click()
    seen("the acknowledgement stays", page.locator("#keys"), "Acknowledged: press RESET")
    page.get_by_role("button", name=re.compile(r"^RESET")).click()
    no_alarm("RESET ends it", page)

    # A pulse of one cycle, 2 ms.
    page.get_by_role("button", name="Pause").click()
    seen("it pauses", status(page, "Speed"), "paused")
    view(page, "Signals")
    page.get_by_label("Search").fill("x.feed_stop")
    row = page.get_by_role("row", name=re.compile("DB31.DBX4.3"))
    row.get_by_role("button", name="Plot").click()
    for value in ["1", "0"]:
        row.get_by_role("button", name=f"Set to {value}").click()
        page.wait_for_timeout(200)
        page.get_by_role("button", name="Step", exact=True).click()
        seen(f"the signal is {value}", row.locator(".value"), value)
    seen("who wrote it", row.locator(".last"), "outside at")
    picture(page, "signals")
    view(page, "Diagram")
    edges = page.get_by_role("list", name="Last edges")
    seen("the pulse is told", edges, "X.feed_stop = 1")
    seen("and its end", edges, "X.feed_stop = 0")
    times = [float(found) for found in re.findall(r"([\d.]+) s  X\.feed_stop = [01]  outside", edges.inner_text())]
    checks.that("it lasts 2 ms", len(times) == 2 and abs(times[0] - times[1] - 0.002) < 1e-9, str(times))
    waves = page.locator("#diagram svg path.wave").evaluate_all("all => all.map(path => path.getAttribute('d'))")
    checks.that("it is drawn", any(wave.count("V") == 2 for wave in waves), str(waves)[:200])
    picture(page, "diagram")
    page.get_by_role("button", name="Go on").click()

    # A fault, its alarm with the cause, and power off and on.
    view(page, "Keys")
    before = seconds(page)
    page.get_by_role("button", name="Fault drive fault of XF").click()
    seen("the alarm has a cause", page.locator("#alarms"), "Cause: ")
    seen("it is announced", page.get_by_role("alert"), "Alarm")
    fault = page.get_by_role("button", name="Fault drive fault of XF")
    expect(fault).to_have_attribute("aria-pressed", "true", timeout=5_000)
    picture(page, "keys")

    # Back to before the fault, and on from there.
    page.get_by_text("Back in time").click()
    page.get_by_label("Moment").evaluate(
        "(slider, time) => { slider.value = time; slider.dispatchEvent(new Event('input')); }", before)
    page.get_by_role("button", name="Go back").click()
    seen("the time is that of before", status(page, "Time"), f"{before:.3f} s")
    seen("it pauses in the past", status(page, "Speed"), "paused")
    no_alarm("the alarm has not been yet", page)
    page.get_by_role("button", name="Go on").click()
    page.wait_for_timeout(500)
    checks.that("it goes on from there", seconds(page) > before + 0.2)
    no_alarm("without the alarm", page)
    seen("the session is a scenario", page.locator("#scenario"), "Save everything since power on")
    recording = page.request.get(f"{server.address}/api/recording")
    checks.that("it can be saved", recording.ok and "[[step]]" in recording.text())

    # Why an axis does not move.
    view(page, "Axes")
    page.get_by_role("row", name=re.compile("controller enable")).first.get_by_role("button", name="ready to start").click()
    seen("the conditions of a lamp", page.locator("#why"), "open")
    picture(page, "axes")

    if axe_core:
        for name, width in [("desktop", 1400), ("phone", 390)]:
            page.set_viewport_size({"width": width, "height": 800})
            for one in VIEWS:
                view(page, one)
                page.wait_for_timeout(300)
                page.evaluate(f"{{ {axe_core} }}; 0")
                found = page.evaluate("axe.run().then(({ violations }) => violations.map(({ id, nodes }) => "
                                      "`${id}: ${nodes.map(({ html }) => html.slice(0, 120)).slice(0, 3)}`))")
                checks.that(f"axe-core finds nothing in {one}, {name}", not found, " ".join(found))
                wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
                checks.that(f"{one} fits a {name}", wide <= 0, f"{wide} pixels too wide")
                picture(page, f"{name}-{one.lower()}")
        page.set_viewport_size({"width": 1400, "height": 900})

    # A killed server is seen, and the page is back by itself.
    port = server.port
    server.end(signal.SIGKILL)
    seen("the loss is shown", page.locator("#link"), "connection lost")
    picture(page, "lost")
    server = Server(program, machine, "--plc", "enable_all", port=port)
    try:
        expect(page.locator("#link")).to_have_text("live", timeout=15_000)
        checks.that("the page is back", True)
    except AssertionError as error:
        checks.that("the page is back", False, str(error)[:200])
    page.wait_for_timeout(500)
    checks.that("with the new machine", seconds(page) < 60)
    server.end()

    # Texts of files are texts.
    with tempfile.TemporaryDirectory() as folder:
        scenario = Path(folder) / "texts.toml"
        scenario.write_text(SCENARIO.format(machine=machine))
        server = Server(program, "--scenario", str(scenario))
        page = tab()
        view(page, "Scenario")
        seen("letters of HTML are letters", page.locator(".steps"), "<b>bold</b> <img src=x")
        checks.that("and no elements", page.locator("#scenario b, #scenario img").count() == 0)
        seen("the step that waits", page.locator(".steps [aria-current=step]"), "time > 3000")
        picture(page, "scenario")
        server.end()

    # The panel of a PLC program: its lamps are those of the program.
    server = Server(program, machine, "--plc", "machine_control_panel")
    page = tab()
    view(page, "Keys")
    page.get_by_role("button", name="CHAIN").click()
    page.get_by_role("button", name=re.compile("^ACK")).click()
    seen("NC ready", page.locator(".lamp-only", has_text="ready"), "lit")
    page.get_by_role("button", name=re.compile("^JOG")).click()
    seen("the lamp of JOG", page.get_by_role("button", name="JOG, lit"), "JOG")
    picture(page, "panel")
    server.end()
    checks.that("nothing is loaded from elsewhere", not foreign, str(foreign))
    checks.that("no script fails", not errors, str(errors[:3]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--opennck", required=True, help="the program")
    parser.add_argument("--keep", type=Path, default=PROJECT / "target" / "foreign", help="folder for Playwright")
    parser.add_argument("--pictures", type=Path, help="folder for pictures of the views")
    arguments = parser.parse_args()
    keep = arguments.keep.resolve()
    begin = time.monotonic()
    try:
        sync_playwright, path = playwright(keep), browser()
    except (Absent, ImportError) as absent:
        print(f"live page in a browser  absent: {absent}")
        sys.exit(3)
    from playwright.sync_api import expect
    checks = Checks()
    with sync_playwright() as running:
        chromium = running.chromium.launch(executable_path=path, args=QUIET)
        operate(chromium, arguments.opennck, axe(keep), arguments.pictures, checks, expect)
        version = chromium.version
        chromium.close()
    took = time.monotonic() - begin
    print(f"live page in Chromium {version}  checks {checks.count} failed {checks.failed}, {took:.0f} s")
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
