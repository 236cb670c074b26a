"""Theorems about motions: enclosures, crossings and means, periodic orbits and families of them, equilibria."""
