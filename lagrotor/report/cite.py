"""How to cite, from CITATION.cff: its few plain lines are read without a YAML library."""

import re

from lagrotor.paper import scripts


def citation() -> tuple[list[str], str]:
    """(sentences: how to cite, the references), (a BibTeX entry)."""
    head, _, listed = scripts.beside("CITATION.cff").read_text(encoding="utf-8").partition("references:")
    field = dict(re.findall(r"^(\w+): *(.+)$", head, re.MULTILINE))
    title, authors = field["title"].strip('"'), " and ".join(_names(head))
    sentences = [field["message"]]
    for block in re.split(r"^  - type: ", listed, flags=re.MULTILINE)[1:]:
        work, year = re.search(r"title: *(.+)", block), re.search(r"year: *(\d+)", block)
        if work:
            what = work[1].strip('"') + (f", {year[1]}" if year else "")
            sentences.append(f"{', '.join(_names(block))}: {what}.")
    entry = f"@software{{lagrotor,\n  author = {{{{{authors}}}}},\n  title = {{{{{title}}}}},\n"
    return sentences, f"{entry}  version = {{{field['version']}}},\n  license = {{{field['license']}}}\n}}"


def _names(block: str) -> list[str]:
    """The authors of a block, given name first."""
    whole = re.findall(r"^ +- name: *(.+)$", block, re.MULTILINE)
    parts = re.findall(r"family-names: *(.+)\n +given-names: *(.+)", block)
    return [*whole, *(f"{given} {family}" for family, given in parts)]
