"""Hamiltonian mechanics: brackets, normal forms, return maps.

    Hamiltonian            H(q, p, t) of a System: brackets, integrals, generated transformations (`hamiltonians`)
    Polynomial             a truncated power series in several variables (`polynomials`); of expressions and of programs
                           (`taylor_series`)
    NormalCoordinates      modes of the quadratic part with the sign of their energy (`normal_coordinates`)
    NormalForm             Birkhoff's normal form about an equilibrium (`normal_forms`)
    ReturnMapForm          the same of a canonical map, and of the return map of a periodic orbit (`return_maps`)

A new normal form is made of `lie_transform` and `poisson_bracket` of `polynomials`, once a quadratic part is diagonal.
"""
