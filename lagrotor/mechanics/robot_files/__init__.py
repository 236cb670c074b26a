"""Robot files: a URDF or MJCF file as a `System` with the numbers of the file.

    Element            a checked element of an XML file (`xml_elements`)
    Pose               a fixed displacement in exact rationals (`poses`)
    Description        links, joints, closures, and the fields of the RobotSystem of them (`description`)
    read_urdf          the Description of a URDF file (`urdf`)
    read_mjcf          the Description of an MJCF file (`mjcf`), with inertias of geoms (`geoms`)

Another format is a module with a function that returns a Description.
"""
