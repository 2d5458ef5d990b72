"""Contact of rough elastic surfaces: the functions of the command ``rc``, with arrays in and out.

A rigid rough surface is pressed into an elastic half-space, on a periodic cell, without friction or adhesion.
All quantities are in SI units. A cell of 1 and an E* of 1 give dimensionless results. Arrays have the shape
``(ny, nx)``, row by row. Heights are positive towards the half-space.

>>> import roughcontact as rc
>>> result = rc.solve(rc.Surface(waves=8, seed=1), grid=64, pressure=1e5)
>>> result.converged, result.pressure.shape
(True, (64, 64))

:func:`solve` solves one problem and :func:`sweep` many. :class:`Surface` is a random surface, and :func:`surface`
returns its heights. :func:`read` reads a measured map, :func:`prepare` treats it, and :func:`inspect` describes it.
:func:`study` tells how much its treatment matters.
:func:`load` reads a result folder. :mod:`roughcontact.torch` and :mod:`roughcontact.jax` differentiate contacts.

Bad input raises a ``ValueError`` with the message that the command line prints. Unknown keywords and some wrong types
raise a ``TypeError``. Numbers of equations are those of Putignano, Afferrante, Carbone, Demelio, *A new efficient numerical method
for contact mechanics of rough surfaces*, Int. J. Solids Struct. 49 (2012).
"""

from roughcontact import jax, torch
from roughcontact._core import __version__
from roughcontact._foreign import InputWarning
from roughcontact._maps import HeightMap, channels, inspect, prepare, read
from roughcontact._records import Certificate, ContactSpot, Elements, Leakage, StressDistribution
from roughcontact._result import Result, load
from roughcontact._rows import FieldsAt
from roughcontact._run import Interrupted, NotConvergedError, NotConvergedWarning, Progress
from roughcontact._solve import solve
from roughcontact._study import Study, study
from roughcontact._surface import Surface, surface
from roughcontact._sweep import sweep
from roughcontact._table import Table

__all__ = [
    "Certificate",
    "ContactSpot",
    "Elements",
    "FieldsAt",
    "HeightMap",
    "InputWarning",
    "Interrupted",
    "Leakage",
    "NotConvergedError",
    "NotConvergedWarning",
    "Progress",
    "Result",
    "StressDistribution",
    "Study",
    "Surface",
    "Table",
    "__version__",
    "channels",
    "inspect",
    "jax",
    "load",
    "prepare",
    "read",
    "solve",
    "study",
    "surface",
    "sweep",
    "torch",
]
