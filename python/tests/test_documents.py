"""Python in the documents runs."""

import importlib.util
import pathlib
import re
import shutil

import pytest

ROOT = pathlib.Path(__file__).parents[2]
DOCUMENTS = ("README.md", "python/README.md", "docs/python.md", "docs/sliding.md", "docs/sweeps.md")


def blocks(name):
    """Blocks of Python, each with the word after `python` on its first line, the program that the block needs."""
    found = re.findall(r"^```python[ ,]?(\w*)\n(.*?)^```", (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert found, name
    return found


@pytest.mark.parametrize("name", DOCUMENTS)
def test_python_in_a_document_runs(name, tmp_path, monkeypatch):
    shutil.copy(ROOT / "data/master-curve.csv", tmp_path)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for kind, code in blocks(name):
        if not kind or (kind in ("jax", "torch") and importlib.util.find_spec(kind) is not None):
            exec(compile(code, name, "exec"), names)


def test_the_same_problem_has_the_same_numbers_in_three_programs():
    """The page says how far they may differ; programs that are not installed are left out."""
    names: dict[str, object] = {}
    areas, pressures = {}, {}
    for kind, code in blocks("docs/python.md"):
        if kind not in ("roughcontact", "tamaas", "ContactMechanics"):
            continue
        try:
            exec(compile(code, "python.md", "exec"), names)
        except ModuleNotFoundError as missing:
            assert kind != "roughcontact", missing
            continue
        areas[kind], pressures[kind] = names["area"], names["max_pressure"]
    assert "roughcontact" in areas
    for kind in areas:
        assert areas[kind] == pytest.approx(areas["roughcontact"], rel=2e-3), kind
        assert pressures[kind] == pytest.approx(pressures["roughcontact"], rel=1e-3), kind
