"""Many surfaces side by side, in processes: the digits do not depend on it."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import roughcontact as rc


def main() -> None:
    """Solves on two processes and alone."""
    surface = rc.Surface(waves=8, grid=64)
    alone = rc.sweep(surface, pressures=[1e5, 2e5], seeds=range(1, 5))
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        table = rc.sweep(surface, pressures=[1e5, 2e5], seeds=range(1, 5), executor=pool)
    assert table["area_fraction"].tolist() == alone["area_fraction"].tolist()
    print(table.mean("area_fraction"))


if __name__ == "__main__":
    main()
