"""Hamiltonian mechanics: brackets, normal forms, return maps.

    Hamiltonian            H(q, p, t) of a System: brackets, integrals, generated transformations (`hamiltonians`)
    Polynomial             a truncated power series in several variables (`polynomials`)
    LocalSeries            Taylor series of expressions; TruncatedSeries of programs (`taylor_series`)
    NormalCoordinates      modes of the quadratic part with the sign of their energy (`normal_coordinates`)
    NormalForm             Birkhoff's normal form about an equilibrium (`normal_forms`)
    ReturnMapForm          the normal form of the return map of a periodic orbit (`return_maps`)

A new normal form uses `lie_transform` and `poisson_bracket` of `polynomials` on a series with a diagonal quadratic part.
"""
