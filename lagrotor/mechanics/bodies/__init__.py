"""Frames and rigid bodies: kinetic energies, velocities and places from a sketch of a mechanism.

    Frame            a step from its parent: a turn, a shift, or a joint by name (`moving_frames`, `rigid_bodies`)
    Body             mass, inertia and centre in a frame; its energies are kept as what they are (`rigid_bodies`)
    Contact          a ball or disc on a plane, sphere or cylinder: the gap and the slips (`contacts`)
    Pathway          a force along a path of given length, and loads on bodies (`force_elements`)
    Tree             the same bodies as links of joints (`trees`), from which `articulated` makes accelerations with a number of
                     operations linear in the bodies, by `small_matrices`

A new joint is a function in `moving_frames` that returns a frame, and a method of Frame. A new surface is a class in `contacts`
with a normal, a height and tangents.
"""
