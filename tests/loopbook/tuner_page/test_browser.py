"""The page in a real browser: what a reader does, and that the number shown is Python's.

Where there is no Chromium and no playwright the tests say so and are skipped (make browser installs playwright).
"""

import json
import math
import re
import shutil
import statistics
from pathlib import Path

import pytest

import loopbook as lb
from loopbook.code import emit, pid_block
from loopbook.controllers.pid_forms import PidStandard
from loopbook.tuner_page.page import page
from loopbook.tuner_page.script import script
from loopbook.tuner_page.settings import settings
from loopbook.tuner_page.shown import complete
from loopbook.tuner_page.still import still_svg
from loopbook.tuner_page.widget import module

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: make browser")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
if not CHROMIUM:
    pytest.skip("no chromium on PATH: apt-get install chromium, then make browser", allow_module_level=True)
pytestmark = [pytest.mark.xdist_group("browser"), pytest.mark.long]

QUIET = (
    "no-sandbox",
    "disable-gpu",
    "disable-background-networking",
    "disable-component-update",
    "disable-sync",
    "no-first-run",
    "disable-quic",
)
PROCESS, PID = lb.tf(2, [[40, 1], [12, 1]], 8), PidStandard(0.65, 45, 6, b=0.5, N=10)
DATA = settings(PROCESS, PID, uncertainty={"L": 20}, name="oven")
WIDE, PHONE = {"width": 1440, "height": 900}, {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        running = started.chromium.launch(executable_path=CHROMIUM, args=[f"--{word}" for word in QUIET])
        yield running
        running.close()


@pytest.fixture
def opened(browser, tmp_path):
    """opened(data or text, **context): the page as a file, with the network blocked, and what was asked and said."""
    contexts = []

    def show(content=DATA, fragment="", **context):
        contexts.append(browser.new_context(viewport=context.pop("viewport", WIDE), accept_downloads=True, **context))
        tab = contexts[-1].new_page()
        tab.asked, tab.said = [], []
        contexts[-1].set_offline(True)
        tab.on("request", lambda request: tab.asked.append(request.url))
        tab.on("console", lambda message: tab.said.append(message.text))
        tab.on("pageerror", lambda error: tab.said.append(str(error)))
        path = tmp_path / "page.html"
        text = content if isinstance(content, str) else page(content, "Tuner", still=still_svg(content))
        path.write_text(text, encoding="utf-8")
        tab.goto(path.as_uri() + fragment, wait_until="load")
        tab.wait_for_timeout(150)
        return tab

    yield show
    for context in contexts:
        context.close()


def number(tab, label):
    """The text of one of the numbers."""
    return tab.locator(f'[data-number="{label}"]').inner_text()


def value(text):
    return float(text.replace("−", "-").replace("∞", "inf").split()[0].rstrip("°"))


def state(tab):
    return tab.evaluate("document.querySelector('.live').tuner.state")


def set_knob(tab, name, text):
    field = tab.locator(f'[data-knob="{name}"]').first
    field.fill(text)
    field.press("Enter")
    tab.wait_for_timeout(120)


def python_loop(tab):
    s = state(tab)
    den = [[T, 1] for T in (s["T1"], s["T2"], s["T3"]) if T]
    Ti = math.inf if s["Ti"] is None else s["Ti"]
    pid = PidStandard(s["Kc"], Ti, s["Td"], b=s["b"], c=s["c"], N=s["N"] if s["Td"] else None)
    return lb.Loop(lb.tf(s["K"], den, s["L"]), pid)


def assert_numbers_are_pythons(tab):
    loop = python_loop(tab)
    margins, step = loop.margins(), loop.step("reference").metrics()
    assert value(number(tab, "Ms")) == pytest.approx(margins.Ms.value, rel=5.1e-4)
    assert value(number(tab, "Mt")) == pytest.approx(margins.Mt.value, rel=5.1e-4)
    assert value(number(tab, "gain margin").split(" … ")[1]) == pytest.approx(margins.gain, rel=5.1e-3)
    assert value(number(tab, "phase margin")) == pytest.approx(margins.phase, rel=5.1e-3)
    assert value(number(tab, "delay margin")) == pytest.approx(margins.delay, rel=5.1e-3)
    assert value(number(tab, "overshoot")) == pytest.approx(step.overshoot, rel=5.1e-3, abs=1e-9)
    assert value(number(tab, "settling")) == pytest.approx(step.settling, rel=5.1e-3)
    assert value(number(tab, "IAE load")) == pytest.approx(loop.step("load").iae(), rel=5.1e-3)


def test_the_page_asks_for_nothing_and_complains_of_nothing(opened):
    tab = opened()
    set_knob(tab, "Kc", "0.9")
    tab.get_by_role("button", name="Sensitivity").click()
    tab.get_by_role("button", name="pin", exact=True).click()
    tab.wait_for_timeout(200)
    assert len(tab.asked) == 1 and tab.asked[0].startswith("file://")
    assert tab.said == []


def test_a_slider_is_moved_and_the_numbers_are_those_of_python(opened):
    tab = opened()
    assert_numbers_are_pythons(tab)
    before = number(tab, "Ms")
    for name, key, times in (
        ("Kc", "ArrowRight", 30),
        ("Ti", "ArrowLeft", 20),
        ("L", "ArrowRight", 12),
        ("T1", "ArrowLeft", 15),
    ):
        slider = tab.locator(f'[data-slider="{name}"]').first
        slider.focus()
        for _ in range(times):
            slider.press(key)
    tab.wait_for_timeout(200)
    assert number(tab, "Ms") != before
    assert_numbers_are_pythons(tab)


def test_numbers_are_typed_with_comma_or_point(opened):
    tab = opened()
    set_knob(tab, "Kc", "0,8")
    set_knob(tab, "Ti", "50.5")
    assert state(tab)["Kc"] == 0.8 and state(tab)["Ti"] == 50.5
    assert_numbers_are_pythons(tab)
    set_knob(tab, "Kc", "many")
    assert state(tab)["Kc"] == 0.8 and tab.locator('[data-knob="Kc"]').get_attribute("aria-invalid") == "true"


def test_the_exercise_of_the_documentation_can_be_done(opened):
    told = (Path(__file__).parents[3] / "docs" / "how-to" / "tuner.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \w+ \| `(#tuner:\S+)` \| ([\d.]+) \|$", told, re.M)
    assert len(rows) == 2
    text = complete()[2]
    for fragment, longer in rows:
        tab = opened(text, fragment)
        assert number(tab, "Ms") == "1.4" and f"20 % more dead time makes Ms {longer}." in tab.inner_text(".lbt-words")
        loop = python_loop(tab)
        assert loop.margins().Ms.value == pytest.approx(1.4, abs=5e-4)
        later = loop.with_delay(0.2 * loop.process.delay).margins().Ms.value
        assert later == pytest.approx(float(longer), abs=5e-3)


def test_an_unstable_loop_is_drawn_as_such_and_has_no_settling_time(opened):
    tab = opened()
    set_knob(tab, "Kc", "9")
    words = tab.locator(".lbt-words").inner_text()
    assert words.startswith("Unstable: 2 poles in the right half plane") and "no settling time" in words
    assert tab.locator("[data-number]").count() == 0 or not tab.locator(".lbt-numbers").is_visible()
    tab.get_by_role("button", name="back to the last stable setting").click()
    tab.wait_for_timeout(150)
    assert state(tab)["Kc"] == PID.K and number(tab, "settling").endswith("s")


def test_a_rule_sets_the_knobs_as_python_does_and_says_its_source(opened):
    tab = opened()
    for name in ("simc-pi", "amigo-step-pid", "zn-ultimate-pid", "migo-pi"):
        tab.locator(f'[data-rule="{name}"]').click()
        tab.wait_for_timeout(250)
        ours = lb.tune(PROCESS, name)
        assert state(tab)["Kc"] == pytest.approx(ours.K, rel=1e-8) and state(tab)["Ti"] == pytest.approx(
            ours.Ti, rel=1e-8
        )
        assert ours.source in tab.locator(".lbt-note").inner_text()


def test_undo_redo_reset_and_pins(opened):
    tab = opened()
    press = lambda name: (tab.get_by_role("button", name=name, exact=True).click(), tab.wait_for_timeout(120))  # noqa: E731
    press("pin")
    set_knob(tab, "Kc", "0.9")
    press("pin")
    set_knob(tab, "Kc", "1.2")
    assert tab.locator(".lbt-key svg").count() == 2
    press("undo")
    assert state(tab)["Kc"] == 0.9
    tab.keyboard.press("Control+z")
    press("redo")
    assert state(tab)["Kc"] in (0.9, 1.2)
    press("reset")
    assert state(tab)["Kc"] == PID.K
    for _ in range(4):
        press("pin")
    assert tab.locator(".lbt-key svg").count() == 3  # three at most
    dashes = {line.get_attribute("stroke-dasharray") for line in tab.locator(".lbt-key path").all()}
    assert len(dashes) == 3  # told apart without colour


def test_everything_is_in_the_address(opened):
    tab = opened()
    set_knob(tab, "Kc", "0.9")
    tab.get_by_role("button", name="pin", exact=True).click()
    set_knob(tab, "L", "9.5")
    tab.wait_for_timeout(500)
    address = tab.evaluate("location.hash")
    again = opened(fragment=address)
    assert state(again) == state(tab) and again.locator(".lbt-key svg").count() == 1
    assert number(again, "Ms") == number(tab, "Ms")


def test_the_nyquist_point_follows_the_pointer(opened):
    tab = opened()
    plot = "document.querySelector('.live').tuner.plotOf('right')"
    grip = tab.evaluate(f"{plot}.gripAt(0.05)")
    box = tab.locator(".lbt-plot canvas").nth(1).bounding_box()
    tab.mouse.move(box["x"] + grip["x"], box["y"] + grip["y"])
    tab.mouse.down()
    tab.mouse.move(box["x"] + grip["x"] - 16, box["y"] + grip["y"] + 12, steps=6)
    tab.mouse.up()
    tab.wait_for_timeout(200)
    moved = tab.evaluate(f"{plot}.gripAt({grip['w']!r})")
    assert moved["x"] == pytest.approx(grip["x"] - 16, abs=1) and moved["y"] == pytest.approx(grip["y"] + 12, abs=1)
    assert state(tab)["Kc"] != PID.K and state(tab)["Ti"] != PID.Ti
    assert_numbers_are_pythons(tab)


def test_what_is_dragged_can_be_undone(opened):
    tab = opened()
    box = tab.locator(".lbt-plot canvas").nth(2).bounding_box()
    tab.mouse.move(box["x"] + box["width"] / 2, box["y"] + 40)
    tab.mouse.down()
    tab.mouse.move(box["x"] + box["width"] / 2 + 30, box["y"] + 40, steps=5)
    tab.mouse.up()
    tab.wait_for_timeout(150)
    assert state(tab)["Kc"] > PID.K
    tab.get_by_role("button", name="undo", exact=True).click()
    tab.wait_for_timeout(150)
    assert state(tab)["Kc"] == PID.K


def test_the_files_are_those_of_python(opened):
    tab = opened()
    set_knob(tab, "h", "2")
    with tab.expect_download() as found:
        tab.get_by_role("button", name="ST", exact=True).click()
    block = pid_block(K=0.65, Ti=45.0, Td=6.0, Tf=0.6, b=0.5, c=0.0, h=2.0)
    assert found.value.suggested_filename == "pid.st"
    with open(found.value.path(), encoding="utf-8") as file:
        assert file.read() == emit(block, "st")["pid.st"]
    with tab.expect_download() as found:
        tab.get_by_role("button", name="JSON", exact=True).click()
    with open(found.value.path(), encoding="utf-8") as file:
        told = json.load(file)
    assert told["name"] == "oven" and told["settings"]["h"] == 2 and told["process"]["time_constants"] == [40, 12]


def test_poles_are_dragged(opened):
    tab = opened(settings(PROCESS, h=4.0, poles={"speed": 0.05, "damping": 0.7, "rest": 0.06, "observer": 0.2}))
    assert number(tab, "slowest pole")
    box = tab.locator(".lbt-plot canvas").nth(1).bounding_box()
    at = tab.evaluate("document.querySelector('.live').tuner.plotOf('right').at(-0.05 * 0.7, 0.05 * Math.sqrt(0.51))")
    tab.mouse.move(box["x"] + at[0], box["y"] + at[1])
    tab.mouse.down()
    tab.mouse.move(box["x"] + at[0] - 30, box["y"] + at[1], steps=4)
    tab.mouse.up()
    tab.wait_for_timeout(250)
    assert state(tab)["speed"] > 0.055 and state(tab)["damping"] > 0.72 and tab.said == []


def test_settings_change_at_half_time_with_and_without_a_bump(opened):
    before, after = PidStandard(4.0, 2.0, 0.4, Tf=0.1), PidStandard(5.0, 2.0, 0.8, b=0.5, Tf=0.1)
    tab = opened(settings(lb.tf(1, [1, 2, 1]), after, h=0.1, before=before, steps=(1.0, 0.0)))
    jump = """(() => { const { u } = document.querySelector('.live').tuner.run, half = Math.floor(u.length / 2);
        return Math.abs(u[half] - u[half - 1]); })()"""
    assert tab.evaluate(jump) < 1e-3
    tab.get_by_label("bumpless").uncheck()
    tab.wait_for_timeout(200)
    assert tab.evaluate(jump) > 1
    tab.get_by_role("button", name="remove pin 1").click()
    tab.wait_for_timeout(200)
    assert not tab.get_by_label("bumpless").is_visible() and tab.said == []


def test_a_sine_on_the_measurement_is_folded_by_sampling(opened):
    tab = opened(settings(lb.Process.fopdt(1, 1, 0.1), PidStandard(2.0, 1.0), h=0.1, wave=(0.2, 9.0)))
    assert "Sampled every 0.1 s, the sine of 9 Hz is one of 1 Hz." in tab.locator(".lbt-words").inner_text()
    set_knob(tab, "h", "0,02")
    assert "Sampled" not in tab.locator(".lbt-words").inner_text()


def test_everything_has_a_name_and_the_summary_is_spoken(opened):
    tab = opened()
    kinds = ", ".join(f".lbt {kind}" for kind in ("input", "button", "select", "canvas", "fieldset"))
    nameless = tab.evaluate(
        f"""[...document.querySelectorAll('{kinds}')].filter((e) =>
           !(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim() || e.title)).map(
             (e) => e.outerHTML)"""
    )
    assert nameless == []
    spoken = tab.locator('.lbt-words[role="status"][aria-live="polite"]').inner_text()
    assert re.match(r"Stable and [\w ]+: Ms [\d.]+\. 20 % more dead time makes Ms [\d.]+\.", spoken)
    slider = tab.locator('[data-slider="Ti"]')
    assert slider.get_attribute("aria-valuetext") == "45 s" and "integral time" in slider.get_attribute("aria-label")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_one_screen_on_a_laptop_and_nothing_sticks_out_on_a_phone(opened, scheme):
    laptop = opened(color_scheme=scheme)
    assert laptop.evaluate("document.documentElement.scrollHeight <= innerHeight")
    background = laptop.evaluate("getComputedStyle(document.querySelector('.lbt-card')).backgroundColor")
    assert background == {"light": "rgb(255, 255, 255)", "dark": "rgb(24, 30, 38)"}[scheme]
    small = opened(viewport={"width": 1280, "height": 650}, color_scheme=scheme)
    assert small.evaluate("document.documentElement.scrollHeight <= innerHeight")
    assert small.evaluate(
        "(({ scrollHeight, clientHeight }) => scrollHeight <= clientHeight)(document.querySelector('.lbt-side'))"
    )
    phone = opened(viewport=PHONE, color_scheme=scheme)
    assert phone.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert phone.evaluate("getComputedStyle(document.querySelector('.lbt-foot')).position") == "sticky"


def test_a_rule_takes_its_wishes_from_the_knobs(opened):
    tab = opened()
    for name, text in (("L", "0"), ("T2", "0"), ("w", "0,2"), ("zeta", "0,8")):
        set_knob(tab, name, text)
    tab.locator('[data-rule="damping-pi"]').click()
    ours = lb.tune(lb.tf(2, [40, 1]), "damping-pi", w0=0.2, zeta=0.8)
    assert (state(tab)["Kc"], state(tab)["Ti"]) == pytest.approx((ours.K, ours.Ti), rel=1e-9)
    set_knob(tab, "w", "0,01")
    tab.locator('[data-rule="damping-pi"]').click()
    assert "does not apply: these poles need gains of both signs" in tab.locator(".lbt-note").inner_text()
    assert state(tab)["Kc"] == pytest.approx(ours.K, rel=1e-9) and tab.said == []


def test_without_javascript_the_figure_is_there(opened):
    tab = opened(java_script_enabled=False)
    assert tab.locator("noscript svg, svg").first.is_visible() and "without it, this is the loop" in tab.inner_text(
        "main"
    )


def test_in_a_report_two_pages_share_one_script_and_keep_apart(opened):
    from notebook_reports.export.exporters.html import HtmlExporter

    exported = HtmlExporter().from_notebook_node(
        notebook_of(lb.tuner(PROCESS, PID), lb.tuner(lb.tf(1, [10, 1], 5), 0.5))
    )[0]
    tab = opened(exported)
    assert exported.count(script()) == 1 and tab.locator(".lbt").count() == 2 and tab.said == []
    tab.locator('[data-knob="Kc"]').nth(1).fill("0.7")
    tab.locator('[data-knob="Kc"]').nth(1).press("Enter")
    tab.wait_for_timeout(500)
    states = tab.evaluate("[...document.querySelectorAll('.live')].map((e) => e.tuner.state.Kc)")
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert states == [0.65, 0.7] and tab.evaluate("location.hash").startswith("#tuner2:")


def notebook_of(*shown):
    import nbformat

    outputs = [nbformat.v4.new_output("display_data", data=one._repr_mimebundle_()) for one in shown]
    cells = [
        nbformat.v4.new_markdown_cell("# Loops"),
        nbformat.v4.new_code_cell("x", outputs=outputs, execution_count=1),
    ]
    return nbformat.v4.new_notebook(cells=cells)


def test_the_widget_gives_its_state_back(opened):
    text = f"""<!DOCTYPE html><meta charset="utf-8"><div id="here"></div><script type="module">{
        module().replace("export default loopbookTuner.widget;", "globalThis.widget = loopbookTuner.widget;")
    }
    const kept = {{ data: {json.dumps(DATA)}, state: {json.dumps(DATA["state"])} }};
    globalThis.model = {{ get: (k) => kept[k], set: (k, v) => {{ kept[k] = v; }},
        save_changes: () => {{ globalThis.saved = true; }} }};
    widget.render({{ model, el: document.getElementById("here") }});</script>"""
    tab = opened(text)
    set_knob(tab, "Kc", "0.9")
    assert tab.said == [] and tab.evaluate("saved") is True
    given = tab.evaluate("model.get('state')")
    assert given["Kc"] == 0.9 and given["Ti"] == 45
    pytest.importorskip("anywidget")
    ours = lb.tuner(PROCESS, PID).widget()
    assert ours.pid == PID
    ours.set_state({"state": given})  # what JupyterLab sends
    assert (ours.pid.K, ours.pid.Ti, ours.pid.Td, ours.pid.Tf) == (0.9, 45.0, 6.0, pytest.approx(0.6))
    assert ours.loop.margins().Ms.value == pytest.approx(value(number(tab, "Ms")), rel=5.1e-4)


def test_a_refresh_is_fast(opened, record_property):
    """CPU of the script for each refresh while knobs move; an idle core shows it as time."""
    tab = opened()
    session = tab.context.new_cdp_session(tab)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})

    def script_time():
        return next(
            m["value"] for m in session.send("Performance.getMetrics")["metrics"] if m["name"] == "ScriptDuration"
        )

    def refresh(k):
        before = script_time()
        name, at = (("Kc", 0.65), ("Ti", 45.0), ("L", 8.0), ("T1", 40.0))[k % 4]
        tab.evaluate(
            """([name, x]) => { document.querySelector('.live').tuner.change({ [name]: x }, false);
               return new Promise((done) => requestAnimationFrame(() => setTimeout(done))); }""",
            [name, at * (1 + 0.25 * math.sin(k / 5))],
        )
        return 1e3 * (script_time() - before)

    def round_of(count):
        spent = [refresh(k) for k in range(count)]
        return statistics.median(spent), max(spent)

    round_of(10)  # these are compiled
    median, worst = min(round_of(30) for _ in range(3))  # a machine with other work counts for one core what two share
    told = f"median {median:.1f} ms, worst {worst:.1f} ms of CPU"
    record_property("table", f"refresh of the tuner's page: {told}")
    assert median <= 16 and worst <= 50
