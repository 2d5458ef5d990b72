"""Contacts in programs of JAX, which is imported at the first call.

>>> square = lambda h: (roughcontact.jax.contact(h, cell=1e-3, e_star=1e9, pressure=1e6) ** 2).mean()
>>> jax.jit(jax.grad(square))(heights)    # doctest: +SKIP
"""

from __future__ import annotations

from typing import Any

from roughcontact._derivatives import Contact, needed

__all__ = ["contact"]


def contact(heights: Any, name: str = "pressure", **keywords: Any) -> Any:
    """A number of a contact, or its pressures, that JAX differentiates with respect to the heights.

    Parameters
    ----------
    heights : jax.Array
        Heights (m), shape (ny, nx), best in double precision (``jax_enable_x64``). May be traced: ``jit``, ``grad`` and
        ``vmap`` apply.
    name : {"pressure", "elastic_energy", "mean_pressure", "penetration", "mean_gap"}
        The attribute of :class:`roughcontact.Result`.
    **keywords
        Those of :func:`roughcontact.solve`. ``method`` is "uniform" by default.

    Returns
    -------
    jax.Array
        Shape (ny, nx) or (), with the type of the heights. It has first derivatives in reverse mode only, under the
        conditions of :meth:`roughcontact.Result.gradient`.

    Raises
    ------
    ImportError
        Without JAX.
    """
    jax = needed("jax")
    heights = jax.numpy.asarray(heights)
    of, dtype = Contact(name, keywords), heights.dtype
    of_heights = jax.ShapeDtypeStruct(heights.shape, dtype)
    of_value = of_heights if name == "pressure" else jax.ShapeDtypeStruct((), dtype)

    @jax.custom_vjp  # type: ignore[untyped-decorator]
    def value(h: Any) -> Any:
        return jax.pure_callback(lambda h: of.value(h).astype(dtype), of_value, h, vmap_method="sequential")

    def forward(h: Any) -> Any:
        return value(h), h

    def backward(h: Any, cotangent: Any) -> Any:
        def pull(h: Any, cotangent: Any) -> Any:
            return of.pulled_back(h, cotangent).astype(dtype)

        return (jax.pure_callback(pull, of_heights, h, cotangent, vmap_method="sequential"),)

    value.defvjp(forward, backward)
    return value(heights)
