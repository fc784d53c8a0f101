"""Code in the pages about the package runs."""

from __future__ import annotations

import os
import re
import warnings
from pathlib import Path
from typing import Any

import pytest
import willis

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("page", ["README.md", "book/src/python.md", "crates/willis-py/README.md"])
def test_code_of_pages(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("polars")
    pytest.importorskip("sympy")
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert blocks
    monkeypatch.chdir(tmp_path)
    os.symlink(ROOT / "examples", tmp_path / "examples")
    names: dict[str, Any] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", willis.TrainWarning)
        for block in blocks:
            exec(compile(block, page, "exec"), names)  # noqa: S102 - the page is ours
