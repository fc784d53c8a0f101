"""Long work: how many threads, how long it may take, how far it is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

#: Called with what is counted, how many of it are done, and how many there are.
Progress = Callable[[str, int, int], object]


def watcher(progress: bool | Progress | None) -> tuple[Progress | None, Callable[[], None]]:
    """What is told of progress, and what is done at the end."""
    if not progress:
        return None, lambda: None
    if callable(progress):
        return progress, lambda: None
    tqdm = _bar()
    if tqdm is None:
        return None, lambda: None
    bars: dict[str, Any] = {}

    def told(what: str, done: int, of: int) -> None:
        if what not in bars:
            for bar in bars.values():
                bar.close()
            bars[what] = tqdm(total=of, unit=f" {what}")
        bars[what].update(done - bars[what].n)

    def finish() -> None:
        for bar in bars.values():
            bar.close()

    return told, finish


def _bar() -> Any:
    """The bar of tqdm that can be shown here, if there is one: that of notebooks needs their widgets, and warns without them."""
    from importlib.util import find_spec

    try:
        if find_spec("ipywidgets") is None:
            from tqdm.std import tqdm
        else:
            from tqdm.auto import tqdm
    except (ImportError, ValueError):
        return None
    return tqdm
