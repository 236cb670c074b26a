"""What runs JavaScript for the tests of this folder ends with them."""

from collections.abc import Iterator

import pytest

from tests.report.interactive.in_node import end


@pytest.fixture(scope="session", autouse=True)
def node_ends() -> Iterator[None]:
    yield
    end()
