"""A figure inside the page: its SVG as a data address, and its size."""

import re

from lagrotor.pictures.figures import Picture

# A data address ends at #, and % begins an escape in it; the rest is what an attribute cannot hold. % comes first.
_ESCAPED = {"%": "%25", "#": "%23", "<": "%3C", ">": "%3E", "&": "%26", '"': "'"}


def data_address(picture: Picture) -> str:
    """The `data:` address of a picture."""
    source = picture.svg.read_text(encoding="utf-8")
    for character, escaped in _ESCAPED.items():
        source = source.replace(character, escaped)
    return f"data:image/svg+xml,{source}"


def size(picture: Picture) -> tuple[int, int]:
    """Width and height of a picture in points, rounded, from its SVG."""
    box = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', picture.svg.read_text(encoding="utf-8"))
    return (round(float(box[1])), round(float(box[2]))) if box else (1, 1)
