r"""Files that a source takes in: \input, \import, packages and classes beside it, the main file of a subfile."""

from lagrotor.files import read_text
from lagrotor.paper.source.expansion import Expander, Primitive
from lagrotor.paper.source.tokens import Token, latex_of


def _input(expander: Expander, token: Token) -> bool:
    expander.skip_spaces()
    following = expander.peek()
    if token.text == r"\input" and following is not None and following.kind == "text":
        expander.next()
        name = following.text.partition("\n")[0].partition(" ")[0]
        expander.push([Token("text", following.text[len(name) :], following.at)])
    else:
        name = expander.name()
    return _part(expander, name, token)


def _import(expander: Expander, token: Token) -> bool:
    expander.star()
    folder, name = expander.name(), expander.name()
    return _part(expander, f"{folder.rstrip('/')}/{name}", token)


def _part(expander: Expander, name: str, token: Token) -> bool:
    """Take in a part of the source, a note where it is missing."""
    if not expander.read_file(name) and expander.file is not None:
        expander.notes.append(f"{name} is missing, which line {expander.line(token.at)[1]} takes in")
    return True


def _use(expander: Expander, token: Token) -> bool:
    expander.optional()
    for name in map(str.strip, expander.name().split(",")):
        if name not in expander.loaded:  # TeX takes in a package once
            expander.loaded.add(name)
            expander.read_file(name, (".sty",))
    expander.optional()
    return True


def _class(expander: Expander, token: Token) -> bool:
    options = latex_of(expander.optional() or ()).split(",")
    name = expander.name()
    if expander.document_class and name == "subfiles":
        return True
    if name == "subfiles":
        for option in options:
            expander.document_class = expander.document_class or "article"
            _preamble_of(expander, option.strip())
        return True
    if expander.files > 1 and expander.document_class and token.text == r"\documentclass":
        return True  # a file taken in that could stand by itself: its own preamble is read as it comes
    if not expander.read_file(name, (".cls",)) or token.text == r"\LoadClass":
        expander.document_class = name
    expander.document_class = expander.document_class or name
    expander.counters.begin(name)
    return True


def _preamble_of(expander: Expander, name: str) -> None:
    """The preamble of the main file of a subfile."""
    if name and expander.file is not None:
        path = expander.file.parent / (name if name.endswith(".tex") else f"{name}.tex")
        if path.is_file():
            preamble = read_text(path, "latin-1").partition(r"\begin{document}")[0]
            expander.document_class = ""
            expander.take_in(preamble, path)


FILES: dict[str, Primitive] = {
    **dict.fromkeys((r"\input", r"\include", r"\subfile", r"\subfileinclude", r"\@input"), _input),
    **dict.fromkeys((r"\import", r"\subimport", r"\subincludefrom", r"\includefrom"), _import),
    **dict.fromkeys((r"\usepackage", r"\RequirePackage"), _use),
    **dict.fromkeys((r"\documentclass", r"\LoadClass"), _class),
}
