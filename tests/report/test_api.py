"""The page of public names: all of them, as they are called, and short."""

import inspect
import re

import lagrotor
from lagrotor.report import api


def test_every_public_name_is_there_with_its_call_and_its_words() -> None:
    found = {entry.name: entry for entry in api.entries()}
    assert set(lagrotor.__all__) <= found.keys()
    assert len(found) == len(list(api.entries())), "none twice"
    for entry in found.values():
        assert entry.text, entry.name
        assert all(line for _, line in entry.members), entry.name
    assert found["simulate"].call == "simulate(scene, t, model='auto', tol=1e-09, engine='core', progress=None)"
    assert dict(found["Rotor"].members)["J"].startswith("Transverse inertia about the ground joint")
    assert "save(path)" in dict(found["Trajectory"].members)


def test_a_call_names_every_argument_of_the_code() -> None:
    for entry in api.entries():
        thing = getattr(lagrotor, entry.name, None)
        if thing is not None:
            assert all(re.search(rf"\b{name}\b", entry.call) for name in inspect.signature(thing).parameters)


def test_the_page_can_be_run_and_does_not_change() -> None:
    text = api.api_page()
    for line in re.findall(r"<code>(from .* import \w+)$", text, re.M):
        exec(line, {})
    assert text == api.api_page()
    assert "0x" not in text and text.count("<article") == len(list(api.entries())) == text.count("<h2>")
    assert set(re.findall(r'href="#(\w+)"', text)) <= set(re.findall(r'id="(\w+)"', text))
    assert re.sub(r"<style>.*</style>", "", text, flags=re.S).count("<") < 1500  # short


def test_backticks_are_code() -> None:
    assert api._words("of `sweep(a, b*c)` and omega_1") == "of <code>sweep(a, b*c)</code> and ω₁"
    assert all(entry.text.count("`") % 2 == 0 for entry in api.entries()), "each is closed"
    assert "`" not in api.api_page().partition("<main")[2]


def test_a_name_without_words_is_seen() -> None:
    """Twin: the check of the words fails where there are none."""

    def silent(scene: object) -> None: ...

    assert api._entry("silent", "here", silent).text == ""
