"""What a notebook shows of a result: its `summary`, name → words, as a table."""

from html import escape


class Shown:
    """A result with a `summary`; Jupyter draws it as a table."""

    def summary(self) -> dict[str, str]:
        """What the result is and what it found, name → words."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(says)}</td></tr>" for name, says in self.summary().items()
        )
        return f"<table><caption>{escape(type(self).__name__)}</caption>{rows}</table>"
