"""Contacts in programs of PyTorch, which is imported at the first call.

>>> heights = torch.tensor(heights, requires_grad=True)                             # doctest: +SKIP
>>> p = roughcontact.torch.contact(heights, cell=1e-3, e_star=1e9, pressure=1e6)    # doctest: +SKIP
>>> (p**2).mean().backward()                                                        # doctest: +SKIP
"""

from __future__ import annotations

from functools import cache
from typing import Any

from roughcontact._derivatives import Contact, needed

__all__ = ["contact"]


def contact(heights: Any, name: str = "pressure", **keywords: Any) -> Any:
    """A number of a contact, or its pressures, that PyTorch differentiates with respect to the heights.

    Parameters
    ----------
    heights : torch.Tensor
        Heights (m), shape (ny, nx), best in double precision.
    name : {"pressure", "elastic_energy", "mean_pressure", "penetration", "mean_gap"}
        The attribute of :class:`roughcontact.Result`.
    **keywords
        Those of :func:`roughcontact.solve`. ``method`` is "uniform" by default.

    Returns
    -------
    torch.Tensor
        Shape (ny, nx) or (), with the type and on the device of the heights. It has first derivatives only, under the
        conditions of :meth:`roughcontact.Result.gradient`.

    Raises
    ------
    ImportError
        Without PyTorch.
    """
    return _function().apply(heights, Contact(name, keywords))


@cache
def _function() -> Any:
    """The subclass of torch.autograd.Function."""
    torch = needed("torch")
    base: Any = torch.autograd.Function

    class Function(base):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, heights: Any, of: Contact) -> Any:
            array = heights.detach().cpu().numpy().copy()
            ctx.of, ctx.array, ctx.like = of, array, {"dtype": heights.dtype, "device": heights.device}
            return torch.as_tensor(of.value(array), **ctx.like)

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, cotangent: Any) -> Any:
            return torch.as_tensor(ctx.of.pulled_back(ctx.array, cotangent.cpu().numpy()), **ctx.like), None

    return Function
