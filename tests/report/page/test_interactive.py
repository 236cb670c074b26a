"""The interactive model: its JavaScript against Python, number by number, and the fragment in a browser."""

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, Shock, natural_rate, simulate
from lagrotor.models import exact_orbit
from lagrotor.models.minimal import MODEL
from lagrotor.pair.notation import Phi, r0, theta_0
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.page.interactive import (
    PAGE_ORDER,
    interactive,
)
from lagrotor.theory import series_orbit
from tests.report.in_browser import dom_of, needs_browser

NODE = shutil.which("node")
node = pytest.mark.skipif(NODE is None, reason="node is not installed")

BARS = {"none": (0.0, 0.0), "light": (0.01, 0.1), "heavy": (1.0, 1.0)}
SCENES = [
    (bar, ell, spins)
    for bar, ell in product(BARS.values(), (0.5, 0.7, 1.0, 1.4, 2.0))
    for spins in ((10.0, -10.0), (-7.0, 7.0), (12.0, 5.0), (0.0, -3.0))
]
OPPOSITE = [scene for scene in SCENES if scene[2][0] == -scene[2][1]]
RANDOM = np.random.default_rng(20)
CASES = [
    (0.204, "none", 1.0, (10.0, -10.0)),
    (0.3, "heavy", 1.0, (-7.0, 7.0)),
    (0.3, "light", 2.0, (10.0, -10.0)),
    (0.25, "none", 0.7, (12.0, -12.0)),
]


def script() -> str:
    """What is computed in the browser, and the drawing, as it stands in the fragment but for the call that starts it."""
    text = re.search(r"<script>\n(.*)\n</script>", interactive(), re.DOTALL)
    assert text
    lines = text[1].splitlines()
    assert (lines[0], lines[1], lines[-1]) == ("(() => {", '"use strict";', "})();")
    assert lines[-2] == 'show(document.getElementById("model"));'
    return "\n".join(lines[2:-2])


def run_node(expression: str, source: str | None = None) -> Any:
    """The value of a JavaScript expression after the script; a number that is not finite comes as None."""
    code = f'"use strict";\n{source or script()}\nconsole.log(JSON.stringify({expression}));'
    ran = subprocess.run([str(NODE), "-"], input=code, capture_output=True, encoding="utf-8", check=False)
    assert ran.returncode == 0, ran.stderr[-800:]
    return json.loads(ran.stdout)


def called(name: str, rows: list[list[float]], source: str | None = None) -> Any:
    return run_node(f"{json.dumps(rows)}.map(row => {name}(...row))", source)


def choice(
    r0: float,
    bar: tuple[float, float],
    ell: float,
    spins: tuple[float, float],
    order: int = PAGE_ORDER,
    printed: bool = False,
) -> str:
    """The argument of the script's `motion`."""
    chosen = {"r0": r0, "mass": bar[0], "inertia": bar[1], "ell": ell, "spins": spins, "order": order}
    return json.dumps(chosen | {"printed": printed})


def scene_of(bar: tuple[float, float], ell: float, spins: tuple[float, float], **start: Any) -> Scene:
    return Scene(spins, Rotor(), Link(ell, *bar), **start)


def kind(ell: float) -> str:
    return "equal" if ell == 1 else "short" if ell < 1 else "long"


def scene_started(bar: tuple[float, float], ell: float, spins: tuple[float, float], state: list[float]) -> Scene:
    """The scene whose start is this state of the minimal model."""
    seen = MODEL.observe(scene_of(bar, ell, spins), np.array([state]))
    axes, rates = (tuple(tuple(map(float, row)) for row in part[:, 0]) for part in (seen.axes, seen.rates))
    return scene_of(bar, ell, spins, axes=axes, rates=rates)


# ---- generated functions


@node
def test_rates_and_axes_are_those_of_the_minimal_model() -> None:
    states = RANDOM.uniform(-0.6, 0.6, (len(SCENES), 6))
    constants = called("constants", [[*bar, ell, *spins] for bar, ell, spins in SCENES])
    calls = []
    for (_, ell, _), state, (a, b, k, _, G_1, G_2, *_) in zip(SCENES, states.tolist(), constants, strict=True):
        at = f"axes_{kind(ell)}({state[0]}, {state[1]}, {state[2]}, {k})"
        rates = (f"rate_{kind(ell)}(...{state}, {inertia}, {b}, {k}, {G_1}, {G_2})" for inertia in (a, a + 0.1))
        calls.append(f"[{at}, bar_length(...{at}, {ell}), {', '.join(rates)}]")
    found = run_node(f"[{', '.join(calls)}]")
    for scene, state, sizes, (axes, length, rate, other) in zip(SCENES, states, constants, found, strict=True):
        python = scene_of(*scene)
        a, b, k, sigma, *rest = sizes
        assert [a, b, k] == pytest.approx([*python.inertias, scene[1]], rel=1e-14)
        assert sigma == pytest.approx(python.sigma, rel=1e-13)
        assert rest[:3] == pytest.approx([*python.momenta, natural_rate(python)], rel=1e-13)
        expected = pytest.approx(list(MODEL.rate(python, False)(0.0, state)), rel=1e-9, abs=1e-9)
        assert rate == expected
        assert other != expected  # twin: a heavier axis
        assert axes == pytest.approx(MODEL.observe(python, state[None]).axes.ravel().tolist(), rel=1e-12, abs=1e-14)
        assert length == pytest.approx([scene[1]], rel=1e-13)


@node
@pytest.mark.parametrize("order", [1, 3, 5, 7, 9])
def test_the_series_is_that_of_the_precession_orbit(order: int) -> None:
    sizes, times = RANDOM.uniform(0.01, 0.25, len(OPPOSITE)), RANDOM.uniform(-3, 3, len(OPPOSITE))
    made = [
        f"(m => [m.seriesRate, m.series({t})])(motion({choice(size, *scene, order)}))"
        for size, t, scene in zip(sizes, times, OPPOSITE, strict=True)
    ]
    for (rate, axes), size, t, scene in zip(run_node(f"[{', '.join(made)}]"), sizes, times, OPPOSITE, strict=True):
        orbit = series_orbit(scene_of(*scene), float(size), order)
        assert rate == pytest.approx(orbit.frequency, rel=1e-12)
        assert axes == pytest.approx(orbit(t).ravel().tolist(), rel=1e-9, abs=1e-9)


@node
def test_the_papers_formula_is_the_one_printed() -> None:
    at = np.column_stack([RANDOM.uniform(0, 0.5, 20), RANDOM.uniform(-10, 10, 20)])
    sines, in_x = ([relation.printed for relation in printed(name).relations[:2]] for name in ("5.20", "5.22"))
    sines = np.array(sp.lambdify([theta_0, Phi], sines)(np.arcsin(at[:, 0]), at[:, 1]))
    in_x = np.array(sp.lambdify([r0, Phi], in_x)(*at.T))
    found = np.reshape(called("paper", at.tolist()), (20, 2, 3))
    for i, azimuth in enumerate((at[:, 1], -at[:, 1])):
        inclined = [sines[i] * np.cos(azimuth), sines[i] * np.sin(azimuth), np.sqrt(1 - sines[i] ** 2)]
        assert np.abs(found[:, i].T - inclined).max() < 1e-14
        assert np.abs(found[:, i, 0] + (i - 0.5) - in_x[i]).max() < 1e-14
    assert called("constants", [[0, 0, 1, 10, -10]])[0][7] == pytest.approx(5.7, rel=1e-14)


def printed(identifier: str) -> Any:
    return next(s for s in PAPER.statements("s5_2f_corrected") if s.id == identifier)


# ---- the stepper


@node
@pytest.mark.parametrize(("r0", "bar", "ell", "spins"), CASES)
def test_the_exact_orbit_is_found(r0: float, bar: str, ell: float, spins: tuple[float, float]) -> None:
    found = run_node(
        f"(m => ({{rate: m.exactRate, periodic: m.periodic}}))(motion({choice(r0, BARS[bar], ell, spins)}))"
    )
    assert found["periodic"]
    assert found["rate"] == pytest.approx(exact_orbit(scene_of(BARS[bar], ell, spins), r0).frequency, rel=1e-9)


@node
@pytest.mark.parametrize(
    ("r0", "bar", "ell", "spins"), [*CASES, (0.3, "light", 1.4, (12.0, 5.0)), (0.2, "none", 1.0, (9.0, 9.0))]
)
def test_ten_seconds_are_those_of_the_minimal_model(
    r0: float, bar: str, ell: float, spins: tuple[float, float]
) -> None:
    times = [0.0, 0.37, 2.5, 10.0]
    made = f"motion({choice(r0, BARS[bar], ell, spins)})"
    found = run_node(f"(m => ({{start: m.exact.states[0], axes: {times}.map(t => m.exact.at(t).axes)}}))({made})")
    scene = scene_started(BARS[bar], ell, spins, found["start"])
    run = simulate(scene, times, model="minimal", tol=1e-13)
    seen = np.reshape(found["axes"], (-1, 2, 3)).swapaxes(0, 1)
    # 48 steps a turn of order 8: 2π/48 to the eighth power is 9e-8, and the scheme's own constant is far below one.
    assert np.abs(seen - run.axes).max() < 1e-8
    # Twin: the midpoint rules without their extrapolation are far off.
    rough = script().replace("return rows[3][3];", "return rows[3][0];")
    missed = run_node(f"(m => {times}.map(t => m.exact.at(t).axes))({made})", rough)
    assert np.abs(np.reshape(missed, (-1, 2, 3)).swapaxes(0, 1) - run.axes).max() > 1e-5


@node
@pytest.mark.parametrize(("bar", "ell"), [("none", 1.0), ("heavy", 1.0), ("light", 1.4), ("heavy", 0.7)])
def test_a_shock_changes_the_motion_as_a_narrow_pulse_does(bar: str, ell: float) -> None:
    impulse, width = (1.1, -0.4), 1e-4
    made = f"motion({choice(0.2, BARS[bar], ell, (10.0, -10.0))})"
    struck = f"m.after(0.3, [{impulse[0]}, {impulse[1]}, 0])"
    says = f"(m => ({{before: m.exact.stateAt(0.3), after: m.ratesOf({struck}.exact.states[0])}}))({made})"
    found = run_node(says)
    force = tuple(p / (np.sqrt(np.pi) * width) for p in impulse)
    start = scene_started(BARS[bar], ell, (10.0, -10.0), found["before"])
    shock = Shock(force=(*force, 0.0), at=10 * width, width=width, body=1)
    run = simulate(replace(start, shock=shock), [0.0, 20 * width], model="minimal", tol=1e-10)
    felt = np.reshape(found["after"], (2, 3))
    assert np.abs(felt - run.rates[:, -1]).max() < 0.03, "the axes turn on by 1e-2 while the pulse lasts"
    assert np.abs(run.rates[:, -1] - run.rates[:, 0]).max() > 0.3, "twin: without the impulse the rates are others"


@node
@pytest.mark.parametrize(("first", "second"), [(0.0, 0.0), (0.0, 5.0), (10.0, -10.0)])
def test_ends_of_the_sliders_are_sound(first: float, second: float) -> None:
    for size in (0.0, 0.5):
        made = f"motion({choice(size, BARS['none'], 0.5, (first, second))})"
        found = run_node(f"(m => ({{end: m.exact.at(5), paired: m.paired, over: m.exact.end}}))({made})")
        assert found["paired"] == (first == -second and first != 0)
        assert found["over"] is None  # never ends
        assert np.linalg.norm(np.reshape(found["end"]["axes"], (2, 3)), axis=1) == pytest.approx([1, 1], rel=1e-12)


@node
def test_a_run_that_meets_the_joint_line_says_when() -> None:
    start = [0.0, 1.2, 0.0, 0.0, 30.0, 0.0]
    made = f"exactRun(y => rate_equal(...y, 1.25, 0, 1, 1, -1), y => axes_equal(y[0], y[1], y[2], 1), {start}, 0.01, [1, -1])"
    found = run_node(f"(r => ({{before: r.at(0), after: r.at(30), end: r.end}}))({made})")
    assert found["before"] is not None
    assert found["after"] is None
    assert 0 <= found["end"] < 30


# ---- the fragment


class Reader(HTMLParser):
    """Follows the open elements; keeps tags with their attributes."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, dict[str, str | None], tuple[str, ...]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append((tag, dict(attrs), tuple(self.open)))
        if tag != "input":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def all(self, *tags: str) -> Iterator[tuple[dict[str, str | None], tuple[str, ...]]]:
        return ((attrs, above) for tag, attrs, above in self.seen if tag in tags)


def test_the_fragment_is_one_section_that_needs_nothing_else() -> None:
    text, reader = interactive(), Reader()
    reader.feed(text)
    assert not reader.open
    tag, attributes, _ = reader.seen[0]
    assert (tag, attributes["id"]) == ("section", "model")
    named = [attrs["id"] for _, attrs, _ in reader.seen if "id" in attrs]
    assert all(name and name.startswith("model") for name in named) and len(named) == len(set(named))
    assert [above for _, above in reader.all("script", "style")] == [("section",)] * 2
    assert not re.search(r"https?:|@import|url\(|\bsrc=|fetch\(|import\(", text)
    assert len(text.encode()) < 100_000
    assert all("label" in above for _, above in reader.all("input", "select"))
    assert all(attrs.get("aria-label") for attrs, _ in reader.all("canvas"))
    # What the words say of the rotors and what the orders offer is what is computed.
    assert Rotor() == Rotor(mass=1, length=1, I1=1, I3=1)
    assert re.findall(r'<option value="(\d)"', text)[-1] == str(PAGE_ORDER)
    # Only this section is styled.
    style = re.search(r"<style>(.*?)</style>", text, re.DOTALL)
    assert style
    rules = re.findall(r"([^{};]+)\{", re.sub(r"@media[^{]*\{", "", style[1]))
    assert rules and all(part.strip().startswith("#model") for rule in rules for part in rule.split(","))


# ---- in a browser

# Runs before the fragment, so that no failure of its script is missed. A browser without a screen draws frames when it
# likes: here they come by the clock.
LISTENER = """<script>
window.failures = [];
addEventListener("error", event => failures.push(String(event.message)));
requestAnimationFrame = draw => setTimeout(() => draw(performance.now()), 16);
console.error = console.warn = (...words) => failures.push(words.join(" "));
</script>"""
TRIAL = """<script>
const part = name => document.querySelector(`[data-model="${name}"]`);
const painted = name => {
  const canvas = part(name), seen = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  return new Set(new Uint32Array(seen.buffer)).size;
};
const set = (name, value) => { part(name).value = value; part(name).dispatchEvent(new Event("input")); };
const check = (name, on) => { part(name).checked = on; part(name).dispatchEvent(new Event("input")); };
const soon = () => new Promise(done => setTimeout(done, 200));
const read = () => Object.fromEntries(["exact-length", "paper-length", "series-tip-1", "paper-rate", "exact-rate", "play",
  "r0-value", "second-value", "note"].map(name => [name, part(name).textContent]));
onload = async () => {
  const found = {};
  await soon();
  found.first = read();
  found.painted = ["space", "top", "length"].map(painted);
  const before = part("space").toDataURL();
  part("space").dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
  await soon();
  found.turned = part("space").toDataURL() !== before;
  set("time", 1);
  await soon();
  found.later = read();
  set("r0", 0.4);
  await soon();
  found.larger = read();
  set("rate", "printed");
  await soon();
  found.printed = read();
  check("opposite", false);
  set("second", 5);
  await soon();
  found.other = read();
  part("strike").click();
  await soon();
  found.struck = read();
  part("again").click();
  await soon();
  found.again = read();
  check("opposite", true);
  set("r0", 0.5);
  await soon();
  found.slow = read();
  set("ell", 0.5);
  await soon();
  found.wide = read();
  found.width = [document.documentElement.scrollWidth, innerWidth];
  found.failures = failures;
  document.body.innerHTML = "<pre id=found></pre>";
  document.getElementById("found").textContent = JSON.stringify(found);
};
</script>"""


@needs_browser
@pytest.mark.parametrize("motion_is_welcome", [True, False])
def test_the_fragment_lives_in_a_browser(tmp_path: Path, motion_is_welcome: bool) -> None:
    html = f'<!DOCTYPE html><html lang="en"><meta charset="utf-8"><body>{LISTENER}{interactive()}{TRIAL}</body></html>'
    less = [] if motion_is_welcome else ["--force-prefers-reduced-motion"]
    shown = dom_of(html, tmp_path, "--window-size=900,1400", "--virtual-time-budget=8000", *less)
    told = re.search(r'<pre id="found">(.*?)</pre>', shown, re.DOTALL)
    assert told, shown[-800:]
    found = json.loads(unescape(told[1]))
    assert found["failures"] == []
    # Lines are smoothed: a drawing has many shades, an empty canvas one.
    assert min(found["painted"]) > 20
    assert found["turned"]
    assert found["first"]["play"] == ("Pause" if motion_is_welcome else "Play")
    assert found["first"]["r0-value"] == "0.204"
    assert found["later"]["exact-length"] == "1.000000"
    assert float(found["later"]["paper-length"]) == pytest.approx(1.08, abs=0.005)
    assert "10" in found["later"]["series-tip-1"]  # a power of ten
    # A larger amplitude: a longer bar by the paper's formula, a slower precession.
    assert float(found["larger"]["paper-length"]) > 1.25
    assert float(found["larger"]["exact-rate"]) < float(found["later"]["exact-rate"]) < 8
    assert found["printed"]["paper-rate"] == "5.70000"
    assert found["other"]["second-value"] == "5.0 rad/s"
    assert found["other"]["paper-length"] == "–"
    assert "opposite spins only" in found["other"]["note"]
    assert "After a shock of 3.54 and −0.97 N s" in found["struck"]["note"]
    assert "opposite spins only" in found["again"]["note"], "from the start: without the shock"
    assert "diverges" in found["wide"]["note"] and "converges slowly" in found["slow"]["note"]
    assert found["width"][0] <= found["width"][1]
