"""What the tests share."""

from __future__ import annotations

from pathlib import Path

import pytest
import willis

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="session")
def examples() -> Path:
    return EXAMPLES


@pytest.fixture
def automatic() -> willis.Train:
    return willis.read(EXAMPLES / "zf-8hp70.toml")


@pytest.fixture
def wolfrom() -> willis.Train:
    return willis.read(EXAMPLES / "wolfrom-236.toml")
