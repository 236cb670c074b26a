"""Robot files: a URDF or MJCF file as a `System` with the numbers of the file.

    Element            a checked element of an XML file (`xml_elements`)
    Pose               a fixed displacement in exact rationals (`poses`)
    Description        links, joints, closures, and the RobotSystem of them (`description`)
    read_urdf          the Description of a URDF file (`urdf`)
    read_mjcf          the Description of an MJCF file (`mjcf`), with inertias of geoms (`geoms`)

Another format is a module with a function that returns a Description.
"""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lagrotor.mechanics.robot_files.description import RobotSystem, Symbols


def read_robot(path: str | Path, symbols: "Symbols" = "inertia", base: str = "fixed") -> "RobotSystem":
    """Return the system of a URDF or MJCF file, whichever its root element says."""
    from lagrotor.mechanics.robot_files.xml_elements import read_xml
    from lagrotor.mechanics.systems import System

    if (root := read_xml(path)).tag != "mujoco":
        return System.from_urdf(path, symbols, base)
    if base != "fixed":
        raise root.refusal("an MJCF file says itself which bodies are free: leave out the base")
    return System.from_mjcf(path, symbols)
