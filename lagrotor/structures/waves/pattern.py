"""`Pattern`: a periodic pattern of rotors, and what can be found out about its waves."""

from lagrotor.structures.waves import chern, dispersion, edge_waves, nonlinear_waves
from lagrotor.structures.waves.cell import Cell


class Pattern(Cell):
    """Pattern(joints, steps, bars, spins, turn, rotor, link, gravity, load, friction, hinge, braces): see `Cell`."""

    long_wave_speeds = dispersion.long_wave_speeds
    dispersion = dispersion.dispersion
    chern_numbers = chern.chern_numbers
    edge_waves = edge_waves.edge_waves
    nonlinear_wave = nonlinear_waves.nonlinear_wave
    three_waves = nonlinear_waves.three_waves
