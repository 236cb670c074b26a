"""What every test of the figures needs: a script's names by its figure's key."""

import pytest

from lagrotor.paper import scripts
from lagrotor.pictures import figures


@pytest.fixture(scope="session")
def script():
    """key → the names that the figure's script defines, run once."""
    return lambda key: scripts.run("figures", figures.stems()[str(key)])
