"""Bad files: each is refused with its name, its line and words that say what to do; no other file is opened."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lagrotor.commands.robot_commands import read_robot
from lagrotor.errors import InputError
from lagrotor.mechanics import System

BODY = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
ENDS = '<parent link="a"/><child link="b"/>'
URDF = {
    "<robot": "no XML",
    "": "no XML",
    "<sdf/>": "root element <robot>",
    "<mujoco/>": "read it by System.from_mjcf",
    '<!DOCTYPE robot [<!ENTITY e "1">]><robot/>': "<!DOCTYPE …> can define entities",
    '<robot xmlns:xi="x"><xi:include href="/etc/passwd"/></robot>': "expand it with xacro or XInclude",
    '<robot name="r"><link/></robot>': "attribute name is missing",
    '<robot name="r"><link name="a"/><link name="a"/></robot>': "line 1 has the same name",
    '<robot name="r"><lnk name="a"/></robot>': "no such element is read inside <robot>: link",
    '<robot name="r"><link name="a"/><link name="b"/></robot>': "a URDF file is one tree with one root",
    '<robot name="r"><link name="a"/></robot>': "nothing moves in it",
}
# What is in the joint j from a to b, what is in the link b.
JOINTS = {
    (f'type="hinge">{ENDS}', BODY): "type='hinge' is none of fixed, revolute",
    (f'type="revolut">{ENDS}', BODY): ": revolute?",
    (f'typ="revolute">{ENDS}', BODY): "attribute type is missing",
    ('type="fixed"><parent link="a"/>', BODY): '<child link="…"/>: add it',
    ('type="fixed"><parent link="a"/><child link="B1"/>', BODY): "there is no link 'B1'",
    (f'type="revolute">{ENDS}<axis xyz="0 0 0"/>', BODY): "no direction",
    (f'type="revolute">{ENDS}<axis xyz="0 1"/>', BODY): "has 2 numbers: give 3",
    (f'type="revolute">{ENDS}<origin rpy="0 nan 0"/>', BODY): "'nan' is no number: write a finite decimal",
    (f'type="revolute">{ENDS}<origin rpy="0 ${{x}} 0"/>', BODY): "expand the file with xacro",
    (f'type="revolute">{ENDS}<origin xyz="1e999999 0 0"/>', BODY): "is no number",
    (f'type="revolute">{ENDS}<origin rqy="1 0 0"/>', BODY): "attribute rqy has no meaning: rpy?",
    (f'type="revolute">{ENDS}<orign/>', BODY): "inside <joint>: origin",
    (f'type="revolute">{ENDS}<dynamics damping="-1"/>', BODY): "must be at least 0",
    (f'type="revolute">{ENDS}<mimic joint="k"/>', BODY): "there is no other joint 'k'",
    (f'type="revolute">{ENDS}', ""): "joint 'j' moves links without mass",
    (f'type="revolute">{ENDS}', "<inertial/>"): "link 'b' has no <mass",
    (f'type="revolute">{ENDS}', BODY.replace('value="1"', 'value="-1"')): "must be at least 0",
    (f'type="revolute">{ENDS}', BODY.replace("ixx", "ixy")): "attribute ixx is missing",
    (f'type="revolute">{ENDS}', BODY.replace('izz="1"', 'izz="5"')): "that of no body",
    (f'type="revolute">{ENDS}', BODY + BODY): "it has 2 elements <inertial>",
    (f'type="revolute">{ENDS}</joint><joint name="k" type="fixed">{ENDS}', BODY): "already the child of joint 'j'",
}
_B = '<body name="b">{}<joint name="q"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>'
_G = '<body name="b"><joint name="q"/>{}</body>'
# What is before <worldbody>, and in it.
MJCF = {
    ("", ""): "nothing moves in it",
    ("", "<bdy/>"): "inside <worldbody>: body",
    ("<wordbody/>", ""): "inside <mujoco>: worldbody",
    ("", _B.format("") * 2): "another body has the same name",
    ("", _B.format('<joint name="q"/>')): "another joint has the name 'q'",
    ("", _B.format('<joint tipe="slide"/>')): "attribute tipe has no meaning: type",
    ("", _B.format('<joint type="screw"/>')): "is none of hinge, slide, ball, free",
    ("", _B.format("<freejoint/>")): "must be the only joint",
    ("", _B.format('<body><freejoint/><geom size="1"/></body>')): "in <worldbody>",
    ("", _B.format('<joint class="no"/>')): "no default class 'no'",
    ("", _B.format('<joint type="ball" armature="1"/>')): "armature and stiffness of a ball joint",
    ("", _B.format('<joint springdamper="1 1"/>')): "write stiffness and damping",
    ("", _B.format("<replicate/>")): "let MuJoCo save the compiled model",
    ("", _B.format('<body quat="1 0 0 0" euler="0 0 0"/>')): "both quat and euler",
    ("", _B.format('<body quat="0 0 0 0"/>')): "gives no direction",
    ("", _B.format('<body xyaxes="1 0 0 2 0 0"/>')): "are parallel",
    ("", _G.format("")): "moves links without mass",
    ("", _G.format('<geom type="mesh" mesh="m"/>')): "needs its mesh, which is not read",
    ("", _G.format('<geom type="capsule" size="1"/>')): "must be 2 positive numbers",
    ("", _G.format('<geom type="capsule" size="1" fromto="0 0 0 0 0 0"/>')): "are one: give two",
    ("", _G.format('<geom size="1" shellinertia="true"/>')): "inertia of a shell",
    ('<compiler coordinate="global"/>', _B): "no meaning in MuJoCo any more",
    ('<compiler angle="grad"/>', _B): "must be degree or radian",
    ('<compiler eulerseq="xyw"/>', _B): "three letters",
    ('<compiler boundmass="1"/>', _B): "boundmass changes inertias",
    ('<equality><tendon/></equality>', _B.format("")): "couples parts that are not read",
    ('<equality><connect body1="c" anchor="0 0 0"/></equality>', _B.format("")): "there is no body 'c'",
    ('<equality><connect body1="b" anchor="0 0 0"/></equality>', _B.format("")): "binds no coordinate",
    ('<equality><joint joint1="p"/></equality>', _B.format("")): "is no hinge and no slide",
    ('<include file="../other.xml"/>', ""): "is outside the folder",
    ('<include file="/etc/hostname"/>', ""): "is outside the folder",
    ('<include file="missing.xml"/>', ""): "is no file in",
    ('<include file="m.xml"/>', ""): "included already",
}  # fmt: skip


def refused(tmp_path: Path, name: str, text: str, words: str, read: Callable[..., Any] | None = None) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as refusal:
        read(tmp_path / name) if read else read_robot(tmp_path / name, "inertia", "fixed")
    assert words in str(refusal.value) and len(str(refusal.value)) < 500 and "\n" not in str(refusal.value)
    assert str(tmp_path) in str(refusal.value)


@pytest.mark.parametrize("text", URDF)
def test_bad_urdf(tmp_path: Path, text: str) -> None:
    refused(tmp_path, "m.urdf", text, URDF[text], System.from_urdf)


@pytest.mark.parametrize("case", JOINTS)
def test_bad_joints_and_links(tmp_path: Path, case: tuple[str, str]) -> None:
    joint, body = case
    text = f'<robot name="r">\n<link name="a"/>\n<link name="b">{body}</link>\n<joint name="j" {joint}</joint></robot>'
    refused(tmp_path, "m.urdf", text, JOINTS[case])


@pytest.mark.parametrize("case", MJCF)
def test_bad_mjcf(tmp_path: Path, case: tuple[str, str]) -> None:
    before, bodies = case
    text = f"<mujoco>\n{before}\n<worldbody>\n{bodies}\n</worldbody></mujoco>"
    refused(tmp_path, "m.xml", text, MJCF[case])


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.xml").write_text("<mujocoinclude/>")
    (tmp_path / "inside").mkdir()
    (tmp_path / "inside" / "link.xml").symlink_to(tmp_path / "secret.xml")
    refused(tmp_path / "inside", "m.xml", '<mujoco><include file="link.xml"/></mujoco>', "is outside the folder")


def test_bad_arguments(tmp_path: Path) -> None:
    path = tmp_path / "m.urdf"
    for read in (System.from_urdf, System.from_mjcf):
        with pytest.raises(InputError, match="No such file"):
            read(tmp_path / "missing.xml")
        with pytest.raises(InputError, match="must be a path"):
            read(3)
    path.write_text(f'<robot name="r"><link name="a">{BODY}</link></robot>')
    with pytest.raises(InputError, match="'inertia', 'all' or 'none'"):
        System.from_urdf(path, symbols="some", base="floating")
    with pytest.raises(InputError, match="'fixed' or 'floating'"):
        System.from_urdf(path, base="free")
    deep = "<mujoco><worldbody>" + "<body>" * 500 + "</body>" * 500 + "</worldbody></mujoco>"
    refused(tmp_path, "m.xml", deep, "elements are nested")
