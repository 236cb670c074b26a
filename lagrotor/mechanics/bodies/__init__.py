"""Frames and rigid bodies: positions, velocities and energies from the joints of a mechanism.

    Frame            a step from its parent: a turn, a shift, or a joint by name (`moving_frames`, `rigid_bodies`)
    Body             mass, inertia and centre in a frame, with energies that remember their bodies (`rigid_bodies`)
    Contact          a ball or disc on a plane, sphere or cylinder: the gap and the slip velocities (`contacts`)
    Pathway          springs, dampers and actuators along a path; loads on bodies (`force_elements`)
    Tree             the same bodies as links of joints (`trees`); `articulated` computes their accelerations with a number of
                     operations linear in the number of bodies, by `small_matrices`

A new joint is a function in `moving_frames` that returns a frame, and a method of Frame. A new surface is a class in `contacts`
with _normal, _height and _tangents.
"""
