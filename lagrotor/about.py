"""The version, known to every room without importing the package's face."""

__version__ = "0.2.0"
