"""The notebooks run from the first cell to the last."""

from __future__ import annotations

from pathlib import Path

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("path", sorted(Path(__file__).parents[1].glob("notebooks/*.ipynb")), ids=lambda p: p.stem)
def test_it_runs(path: Path) -> None:
    pytest.importorskip("matplotlib")
    book = nbformat.read(path, as_version=4)
    nbformat.validate(book)
    assert all(not cell.get("outputs") for cell in book.cells), "notebooks are kept without outputs"
    client = nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(ROOT)}})
    client.execute()
