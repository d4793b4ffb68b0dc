"""Settings shared by all tests."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import settings

# Compiling and first calls make single examples slow on a busy machine; that is no failure.
# The same examples every time, so that one commit has one verdict; to look for new ones:
# pytest --hypothesis-profile=explore
settings.register_profile("armik", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None)
settings.load_profile("armik")

REPOSITORY = Path(__file__).resolve().parent.parent

# The ledger is no part of the installed package; at the end of the path, so that the installed package
# is the one under test.
sys.path.append(str(REPOSITORY))


@pytest.fixture(scope="session")
def recordings() -> Path:
    """Folder of recorded human motion beside the checkout; tests that need it skip where it is absent."""
    folder = REPOSITORY.parent / "shared" / "data" / "human_motion"
    if not folder.is_dir():
        pytest.skip(f"recordings not found in {folder}: they are not part of this project")
    return folder
