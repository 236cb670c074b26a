"""Periodic patterns of rotors: bands, gaps, group velocity, Chern numbers."""
