"""Signatures, stubs and docstrings are complete."""

import ast
import graphlib
import inspect
import pathlib
import subprocess
import sys

import pytest

import roughcontact as rc
from roughcontact import _core

PACKAGE = pathlib.Path(rc.__file__).parent

#: Keys of a scene that calls have in another way: the argument `heights`, and what concerns standard output.
IN_ANOTHER_WAY = {"heights", "out", "quiet", "json", "strict"}

#: Keys for files.
OF_FILES = {"missing", "mask"}


def test_solve_has_every_key_of_a_scene():
    keywords = set(inspect.signature(rc.solve).parameters)
    own = {"scene", "progress", "check", "heights", "strict"}
    assert keywords - own == (set(_core.known_keys()) | OF_FILES) - IN_ANOTHER_WAY


def test_sweep_and_surface_have_the_keywords_of_solve():
    of = lambda function: inspect.signature(function).parameters  # noqa: E731
    solve, sweep = of(rc.solve), of(rc.sweep)
    own = {"pressures", "penetrations", "speeds", "times", "seeds", "vary", "executor", "keep_results", "out", "resume", "fields"}
    one = {"pressure", "penetration", "seed", "area_error", "history", "history_steps", "fluid_pressure", "output_grid", "precision", "elements", "friction", "shear_pressure", "shear_displacement", "shear_angle", "uncoupled", "unit", "height_unit", "height_scale", "channel", "layout"}
    assert set(sweep) - own == set(solve) - one
    for name in set(sweep) - own:
        assert sweep[name].annotation == solve[name].annotation, name
    for name in of(rc.Surface).keys() - {"add"}:  # only beside an array it is an array
        assert of(rc.Surface)[name].annotation == solve[name].annotation == of(rc.surface)[name].annotation, name


def imported(path):
    """The modules of the package that a module imports anywhere, also in a function or for its types alone."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module == "roughcontact":
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").removeprefix("roughcontact.")


def test_no_two_modules_import_each_other():
    names = {path.stem for path in PACKAGE.glob("*.py")}
    uses = {path.stem: names & set(imported(path)) for path in PACKAGE.glob("*.py")}
    assert "_records" in uses["_result"], "the imports were not found"
    # A circle is an error that names its modules.
    graphlib.TopologicalSorter(uses).prepare()


def stubs():
    tree = ast.parse((PACKAGE / "_core.pyi").read_text())
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef) and node.name not in ("Given", "Wanted")}
    return functions, classes


def arguments(node):
    return [argument.arg for argument in node.args.args]


def test_the_stub_has_the_names_and_arguments_of_the_module():
    functions, classes = stubs()
    public = {name for name in dir(_core) if not name.startswith("__")}
    assert public == set(functions) | set(classes)
    for name, node in functions.items():
        assert arguments(node) == list(inspect.signature(getattr(_core, name)).parameters), name
    for kind, stub in classes.items():
        methods = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
        assert {name for name in dir(getattr(_core, kind)) if not name.startswith("__")} == set(methods), kind
        for name, node in methods.items():
            member = getattr(getattr(_core, kind), name)
            if callable(member):
                assert arguments(node) == list(inspect.signature(member).parameters), name


def test_everything_public_is_documented_and_its_parameters_are():
    for name in rc.__all__:
        if name.startswith("__"):
            continue
        member = getattr(rc, name)
        assert inspect.getdoc(member), name
        if inspect.isfunction(member) and name not in ("surface", "sweep"):
            for parameter in inspect.signature(member).parameters:
                assert parameter in member.__doc__, f"{name}: {parameter}"
        if inspect.isclass(member) and not issubclass(member, BaseException):
            for attribute, value in vars(member).items():
                if not attribute.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{attribute}"


def test_package_and_examples_are_typed():
    pytest.importorskip("mypy")
    root = pathlib.Path(__file__).parents[1]
    files = sorted((root / "examples").glob("*.py"))
    assert files
    line = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", "/dev/null", *map(str, files)]
    done = subprocess.run(line, capture_output=True, text=True, check=False, cwd=root / "examples")
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("path", sorted((pathlib.Path(__file__).parents[1] / "examples").glob("*.py")), ids=lambda p: p.stem)
def test_examples_run(path, tmp_path):
    done = subprocess.run([sys.executable, path], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0 and done.stdout, done.stderr
