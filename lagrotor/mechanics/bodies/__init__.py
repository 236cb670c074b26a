"""Frames and rigid bodies: kinetic energies, velocities and places from a sketch of a mechanism."""
