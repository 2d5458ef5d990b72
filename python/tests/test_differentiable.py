"""Contacts as functions that JAX and PyTorch differentiate, and the products of vectors and Jacobians behind them.

Where a framework is not installed, a stand-in of a few lines calls the wrapper as the framework would.
"""

import importlib
import subprocess
import sys
import types

import numpy as np
import pytest

import roughcontact as rc
from roughcontact._derivatives import Contact

SCENE = {"cell": 1e-3, "e_star": 1e9, "pressure": 1e6, "tolerance": 1e-13}


@pytest.fixture(scope="module")
def heights():
    return rc.surface(waves=4, grid=32, seed=3, cell=1e-3)


def central(function, heights, at, step):
    """The derivative with respect to one height."""
    values = []
    for sign in (1, -1):
        changed = np.array(heights)
        changed.flat[at] += sign * step
        values.append(float(function(changed)))
    return (values[0] - values[1]) / (2 * step)


@pytest.mark.parametrize("name", ["pressure", "elastic_energy", "penetration", "mean_gap"])
def test_a_pulled_back_vector_is_a_central_difference(heights, name):
    of = Contact(name, SCENE)
    vector = np.random.default_rng(4).normal(size=of.value(heights).shape)
    gradient = of.pulled_back(heights, vector)
    pressure = rc.solve(heights, method="uniform", **SCENE).pressure
    for at in (np.argmax(pressure), np.argmin(pressure), np.argmax(heights)):
        difference = central(lambda h: np.vdot(vector, of.value(h)), heights, at, 1e-4 * np.ptp(heights))
        assert gradient.flat[at] == pytest.approx(difference, abs=1e-6 * np.abs(gradient).max())


def test_a_result_is_solved_once_and_few_are_kept(heights, monkeypatch):
    solved = []
    monkeypatch.setattr("roughcontact._derivatives.solve", lambda *a, **k: solved.append(1) or rc.solve(*a, **k))
    of = Contact("mean_gap", {**SCENE, "tolerance": 1e-6})
    for factor in (1.0, 1.0, 0.9, 0.8, 0.7, 0.6, 1.0):
        of.pulled_back(factor * heights, 1.0)
    assert len(solved) == 6


@pytest.mark.parametrize("framework", ["jax", "torch"])
def test_without_a_framework_one_line_says_what_to_install(heights, framework, monkeypatch):
    monkeypatch.setitem(sys.modules, framework, None)
    rc.torch._function.cache_clear()
    with pytest.raises(ImportError, match=rf"^roughcontact.{framework}: needs {framework}; install it with: pip install {framework}$"):
        getattr(rc, framework).contact(heights, **SCENE)


def test_no_framework_is_imported_with_the_package():
    code = "import sys, roughcontact; assert not {'jax', 'torch'} & set(sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def jax_or_stand_in(monkeypatch):
    """jax, or what the wrapper uses of it. `grad` then calls the functions of `defvjp`."""
    try:
        jax = importlib.import_module("jax")
        jax.config.update("jax_enable_x64", True)
        return jax
    except ImportError:
        pass
    made = []

    class custom_vjp:  # noqa: N801
        def __init__(self, function):
            self.function = function
            made.append(self)

        def defvjp(self, forward, backward):
            self.rules = (forward, backward)

        def __call__(self, heights):
            self.heights = heights
            return self.function(heights)

    def pure_callback(function, shape, *arguments, vmap_method):
        result = function(*arguments)
        assert result.shape == shape.shape and result.dtype == shape.dtype and vmap_method == "sequential"
        return result

    def grad(function):
        def gradient(heights):
            made.clear()
            function(heights)
            (contact,) = made
            value, kept = contact.rules[0](contact.heights)
            return contact.rules[1](kept, np.ones_like(value))[0]

        return gradient

    jax = types.SimpleNamespace(
        numpy=np,
        ShapeDtypeStruct=lambda shape, dtype: types.SimpleNamespace(shape=shape, dtype=dtype),
        custom_vjp=custom_vjp,
        pure_callback=pure_callback,
        grad=grad,
        jit=lambda function: function,
    )
    monkeypatch.setitem(sys.modules, "jax", jax)
    return jax


def test_jax_differentiates_a_contact(heights, monkeypatch):
    jax = jax_or_stand_in(monkeypatch)
    energy = lambda h: rc.jax.contact(h, "elastic_energy", **SCENE)  # noqa: E731
    gradient = np.asarray(jax.jit(jax.grad(energy))(heights))
    assert gradient == pytest.approx(rc.solve(heights, method="uniform", **SCENE).gradient("elastic_energy"), rel=1e-12)
    total = lambda h: rc.jax.contact(h, **SCENE).sum()  # noqa: E731
    if not isinstance(jax, types.SimpleNamespace):
        of_squares = jax.grad(lambda h: (rc.jax.contact(h, **SCENE) ** 2).mean())(heights)
        result = rc.solve(heights, method="uniform", **SCENE)
        expected = result.gradient_of(2 * result.pressure / heights.size)
        assert np.asarray(of_squares) == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
        stacked = jax.vmap(jax.grad(energy))(np.stack([heights, 2 * heights]))
        assert np.asarray(stacked)[0] == pytest.approx(gradient, rel=1e-12)
    assert float(total(heights)) == pytest.approx(1e6 * heights.size, rel=1e-9)


def torch_or_stand_in(monkeypatch):
    """torch, or what the wrapper uses of it, and a function that makes a leaf from an array."""
    rc.torch._function.cache_clear()
    try:
        torch = importlib.import_module("torch")
        return torch, lambda array: torch.tensor(array, requires_grad=True)
    except ImportError:
        pass

    class Tensor:
        def __init__(self, array):
            self.array, self.grad, self.origin = array, None, None
            self.dtype, self.device = array.dtype, "cpu"

        def detach(self):
            return self

        cpu = detach

        def numpy(self):
            return self.array

        def backward(self):
            function, context, leaf = self.origin
            gradient, nothing = function.backward(context, Tensor(np.ones_like(self.array)))
            assert nothing is None
            leaf.grad = gradient

    class Function:
        @classmethod
        def apply(cls, leaf, *others):
            context = types.SimpleNamespace()
            value = cls.forward(context, leaf, *others)
            value.origin = (cls, context, leaf)
            return value

    function = types.SimpleNamespace(once_differentiable=lambda f: f)
    torch = types.SimpleNamespace(
        autograd=types.SimpleNamespace(Function=Function, function=function),
        as_tensor=lambda array, dtype, device: Tensor(np.asarray(array, dtype=dtype)),
    )
    monkeypatch.setitem(sys.modules, "torch", torch)
    return torch, Tensor


def test_torch_differentiates_a_contact(heights, monkeypatch):
    torch, leaf_of = torch_or_stand_in(monkeypatch)
    result = rc.solve(heights, method="uniform", **SCENE)
    leaf = leaf_of(heights)
    rc.torch.contact(leaf, "mean_gap", **SCENE).backward()
    assert leaf.grad.numpy() == pytest.approx(result.gradient("mean_gap"), rel=1e-12)
    if not isinstance(torch, types.SimpleNamespace):
        leaf = leaf_of(heights)
        (rc.torch.contact(leaf, **SCENE) ** 2).mean().backward()
        expected = result.gradient_of(2 * result.pressure / heights.size)
        assert leaf.grad.numpy() == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
