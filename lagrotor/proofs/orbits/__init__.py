"""Theorems about motions: enclosures, crossings and means, periodic orbits, equilibria."""
