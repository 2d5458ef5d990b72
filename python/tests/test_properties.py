"""Arrays of every shape, type and layout, and values that make no sense."""

import re

import numpy as np
import pytest

pytest.importorskip("hypothesis")
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import roughcontact as rc

settings.register_profile("tests", deadline=None, max_examples=60, derandomize=True)
settings.load_profile("tests")

CONTACT = {"cell": 1.0, "e_star": 1.0, "pressure": 1e-2, "threads": 1, "tolerance": 1e-3}

#: Names of types and flags of other languages, which mean nothing to a user of Python.
FOREIGN = re.compile(r"usize|u64|i64|f64|--[a-z]|panick|unwrap")

LAYOUTS = {
    "as it is": lambda h: h,
    "Fortran": np.asfortranarray,
    "every second": lambda h: np.repeat(np.repeat(h, 2, axis=0), 2, axis=1)[::2, ::2],
    "backwards": lambda h: np.ascontiguousarray(h[::-1, ::-1])[::-1, ::-1],
    "part of a larger one": lambda h: np.pad(h, 3)[3:-3, 3:-3],
    "transposed": lambda h: np.ascontiguousarray(h.T).T,
    "list": lambda h: h.tolist(),
    "other byte order": lambda h: h.astype(h.dtype.newbyteorder()),
}

shapes = st.tuples(st.integers(1, 12), st.integers(1, 12))
types = st.sampled_from([np.float64, np.float32, np.float16, np.int16, np.uint8, np.int64, np.bool_])


def elements(dtype):
    if np.issubdtype(dtype, np.floating):
        return st.floats(-100, 100, width=np.dtype(dtype).itemsize * 8)
    return None if dtype is np.bool_ else st.integers(0, 100)


heights_of_any_type = types.flatmap(lambda dtype: arrays.arrays(dtype, shapes, elements=elements(dtype)))


def said_or_digits(heights):
    try:
        result = rc.solve(heights, **CONTACT)
    except ValueError as refused:
        return str(refused)
    return result.pressure.shape, result.pressure.tobytes()


# Heights of a hundred cells, or of nearly nothing, need not converge.
@pytest.mark.filterwarnings("ignore::roughcontact.NotConvergedWarning", "ignore::roughcontact.InputWarning")
@given(heights_of_any_type, st.sampled_from(sorted(LAYOUTS)))
def test_type_and_layout_of_an_array_change_nothing(heights, layout):
    assume(layout != "list" or heights.dtype in (np.float64, np.int64, np.bool_))
    plain = np.ascontiguousarray(heights, dtype=np.float64)
    before = heights.copy()
    assert said_or_digits(LAYOUTS[layout](heights)) == said_or_digits(plain)
    assert np.array_equal(heights, before)


@pytest.mark.filterwarnings("ignore::roughcontact.NotConvergedWarning", "ignore::roughcontact.InputWarning")
@given(arrays.arrays(np.float64, shapes, elements=st.floats(-1e-2, 1e-2)), st.data())
def test_a_result_has_the_shape_and_the_load_that_were_asked_for(heights, data):
    assume(np.ptp(heights) > 1e-6)
    cell_y = data.draw(st.sampled_from([None, 0.5, 2.0]))
    try:
        result = rc.solve(heights, **CONTACT, cell_y=cell_y)
    except ValueError as refused:
        assert not FOREIGN.search(str(refused)), refused
        return
    assert result.pressure.shape == result.gap.shape == heights.shape
    # Without a size for y, spacings are equal.
    assert result.sides == pytest.approx((1.0, cell_y or heights.shape[0] / heights.shape[1]), rel=1e-12)
    assert (result.pressure >= 0).all() and result.pressure.mean() == pytest.approx(1e-2, rel=1e-9)


@pytest.mark.filterwarnings("ignore::roughcontact.InputWarning")
@given(arrays.arrays(np.float64, st.tuples(st.integers(2, 9), st.integers(2, 9)), elements=st.floats(-1, 1)), st.data())
def test_a_value_that_is_not_a_height_is_named_with_its_place(heights, data):
    row, column = (data.draw(st.integers(0, n - 1)) for n in heights.shape)
    heights[row, column] = bad = data.draw(st.sampled_from([np.nan, np.inf, -np.inf]))
    with pytest.raises(ValueError, match=rf"^heights: row {row}, column {column} \(from 0\) is {'NaN' if np.isnan(bad) else bad}"):
        rc.solve(heights, **CONTACT)


@given(st.one_of(st.just(()), arrays.array_shapes(max_dims=1), arrays.array_shapes(min_dims=3, max_dims=5, max_side=3)))
def test_other_numbers_of_dimensions_are_refused(shape):
    with pytest.raises(ValueError, match="^heights: must be a 2-D array"):
        rc.solve(np.zeros(shape), **CONTACT)


NUMBERS = ("cell", "cell_y", "young", "poisson", "e_star", "pressure", "penetration", "energy_tolerance", "tolerance", "hurst", "rms")
COUNTS = ("waves", "seed", "grid", "border_level")
anything = st.one_of(
    st.floats(),
    st.integers(-(2**70), 2**70),
    st.booleans(),
    st.text(max_size=4),
    st.sampled_from([[1.0, 2.0], (1, 2), (1, 2, 3), {}, np.float32(2.0), np.array([1.0]), 1j, b"x"]),
)


@pytest.mark.filterwarnings("ignore::roughcontact.NotConvergedWarning")
@given(st.dictionaries(st.sampled_from(NUMBERS + COUNTS), anything, min_size=1, max_size=3))
def test_values_without_a_sense_are_refused_in_one_line_of_python(keys):
    # What happens to be a problem is a small one.
    keys = {"waves": 4, "grid": 16, "pressure": 1e5, "memory_limit": "1MB", "time_limit": 1, **keys}
    try:
        with np.errstate(all="ignore"):
            rc.solve(**keys)
    except (ValueError, TypeError) as refused:
        assert "\n" not in str(refused) and not FOREIGN.search(str(refused)), refused


lengths = st.one_of(st.floats(), st.just("1 mm"), st.none())


@given(st.one_of(st.tuples(lengths, lengths), st.floats(), st.just("ab"), st.lists(lengths, max_size=3)))
def test_the_size_of_a_map_is_two_lengths(sides):
    try:
        made = rc.HeightMap(np.eye(3), sides)
    except ValueError as refused:
        assert str(refused).startswith("sides: must be")
    else:
        assert len(made.sides) == 2 and all(0 < side < np.inf for side in made.sides)
