"""Small worlds."""

import pytest

import sorb


@pytest.fixture
def world() -> sorb.World:
    """216 particles, 27 nodes and a ball."""
    return sorb.World("ball_drop", resolution=0.3)
