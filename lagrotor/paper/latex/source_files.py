r"""Files that a source takes in: \input, \import, packages and classes beside it, the main file of a subfile."""

import re

from lagrotor.files import read_text
from lagrotor.paper.latex.conditions import set_flag
from lagrotor.paper.latex.expansion import Expander, Primitive
from lagrotor.paper.latex.groups import Macro
from lagrotor.paper.latex.tokens import Token, latex_of, tokenize

# Packages and classes of the distributions of TeX that are used most: no command of the source's own is sought in them.
_NAMES = (
    "article report book letter memoir amsart amsbook scrartcl scrreprt scrbook beamer standalone minimal revtex4 revtex4-1"
    " revtex4-2 IEEEtran elsarticle ctexart ctexrep ctexbook acmart svjour3 mnras aastex63 tufte-book tufte-handout exam"
    " amsmath amssymb amsthm amsfonts amstext amsbsy amsopn amscd mathtools bm physics physics2 siunitx siunits braket commath"
    " esdiff diffcoeff derivative empheq breqn IEEEtrantools cases nicefrac xfrac cancel slashed tensor mathrsfs dsfont bbm"
    " bbold esint esvect stmaryrd euscript eucal wasysym textcomp upgreek mathdesign mathspec unicode-math newtxmath newtxtext"
    " mathptmx mathpazo txfonts pxfonts lmodern times helvet courier palatino fourier kpfonts libertine iwona gensymb units"
    " mhchem chemformula accents scalerel relsize ulem soul color xcolor colortbl graphicx graphics epsfig epstopdf svg float"
    " wrapfig caption subcaption subfig subfigure rotating pdflscape lscape placeins afterpage overpic tikz pgf pgfplots"
    " pgfplotstable circuitikz tikz-cd tikz-3dplot tikz-feynman tikzscale xy listings listingsutf8 minted verbatim fancyvrb"
    " alltt algorithm algorithm2e algorithmic algpseudocode array tabularx tabulary booktabs longtable multirow multicol"
    " makecell dcolumn threeparttable hhline arydshln adjustbox framed mdframed tcolorbox todonotes comment hyperref url cite"
    " natbib biblatex cleveref varioref refcount backref bookmark hypcap nameref xr xr-hyper tocloft tocbibind titlesec titletoc"
    " titling sectsty fancyhdr geometry fullpage a4wide a4 layout setspace parskip indentfirst enumitem enumerate paralist"
    " footmisc appendix authblk abstract lineno pdfpages import standalone subfiles inputenc fontenc fontspec babel polyglossia"
    " csquotes microtype xspace etoolbox ifthen calc ifpdf iftex ifxetex ifluatex xparse expl3 xifthen xstring kvoptions pgffor"
    " xkeyval keyval environ thmtools ntheorem chngcntr glossaries glossaries-extra acronym nomencl makeidx imakeidx index lipsum"
    " blindtext datetime datetime2 isodate eurosym pifont marvosym fontawesome fontawesome5 latexsym showkeys showframe nag"
    " fixltx2e ragged2e emptypage lastpage eso-pic transparent draftwatermark grffile moreverb needspace xeCJK ctex CJK CJKutf8"
    " ucs fix-cm cmap lettrine epigraph hyphenat anyfontsize type1cm bigints mathdots yhmath"
)
_DISTRIBUTED = frozenset(_NAMES.split())


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
    options = latex_of(expander.optional() or ())
    for name in map(str.strip, expander.name().split(",")):
        if name not in expander.loaded:  # TeX takes in a package once
            expander.loaded.add(name)
            if _read_style(expander, name, ".sty", options):
                continue
            if name not in _DISTRIBUTED:
                expander.missing.setdefault(f"{name}.sty", expander.line(token.at)[1])
    expander.optional()
    return True


def _later(expander: Expander, token: Token) -> bool:
    r"""\AtBeginDocument{…}, \AtEndOfClass{…}: what is done at the beginning of the document, at the end of the file."""
    body = expander.argument()
    if token.text == r"\AtBeginDocument":
        expander.first += body
    elif (file := expander.innermost_file()) is not None:
        file.after += body
    return True


def _read_style(expander: Expander, name: str, suffix: str, options: str) -> bool:
    """Take in a package or a class beside the source with these options; whether it is there."""
    if not expander.read_file(name, (suffix,)) or (file := expander.innermost_file()) is None:
        return False
    file.prefix = f"{name}@"
    options = ",".join((options, *expander.passed.get(name + suffix, ())))
    file.options = [option.strip() for option in options.split(",")]
    return True


def _option(expander: Expander, token: Token) -> bool:
    r"""\DeclareOption{name}{…}, done at \ExecuteOptions{name}, and at \ProcessOptions where the name is given."""
    star, file = expander.star(), expander.innermost_file()
    if token.text == r"\DeclareOption":
        name, body = "" if star else expander.name(), expander.argument()
        if file is not None:
            file.declared[name] = body
        return True
    options = (
        latex_of(expander.argument()).split(",") if token.text == r"\ExecuteOptions" else file.options if file else []
    )
    for name, body in reversed(file.declared.items() if file else ()):
        expander.push(body if name and name in options else ())
    return True


def _pass_options(expander: Expander, token: Token) -> bool:
    r"""\PassOptionsToPackage{options}{name}: what it is loaded with, too."""
    options, name = latex_of(expander.argument()), expander.name()
    suffix = ".cls" if token.text.endswith("Class") else ".sty"
    expander.passed.setdefault(name + suffix, []).append(options)
    return True


def _key_option(expander: Expander, token: Token) -> bool:
    r"""\DeclareBoolOption[true]{name}, \DeclareStringOption[…]{name} of kvoptions: \ifprefix@name and \prefix@name."""
    file = expander.innermost_file()
    if token.text == r"\SetupKeyvalOptions":
        given = re.search(r"prefix\s*=\s*([^\s,]*)", latex_of(expander.argument()))
        if file is not None and given:
            file.prefix = given[1]
        return True
    default, name = latex_of(expander.optional() or ()).strip(), expander.name()
    if file is None:
        return True
    said = {key.strip(): value.strip() for key, _, value in (each.partition("=") for each in file.options)}
    value = said.get(name, default) or ("true" if name in said else "")
    if token.text == r"\DeclareBoolOption":
        set_flag(expander, f"if{file.prefix}{name}", value == "true")
    else:
        expander.macros[rf"\{file.prefix}{name}"] = Macro(tuple(tokenize(value)))
    return True


def _end_input(expander: Expander, token: Token) -> bool:
    if (file := expander.innermost_file()) is not None:
        file.begin("", 0)
    return True


def _class(expander: Expander, token: Token) -> bool:
    given = latex_of(expander.optional() or ())
    name = latex_of(expander.expand(expander.argument())).strip()
    if expander.document_class and name == "subfiles":
        return True
    if name == "subfiles":
        for option in given.split(","):
            expander.document_class = expander.document_class or "article"
            _preamble_of(expander, option.strip())
        return True
    if expander.files > 1 and expander.document_class and token.text == r"\documentclass":
        return True  # a file taken in that could stand by itself: its own preamble is read as it comes
    bare = name.rpartition("/")[2]
    distributed = bare in _DISTRIBUTED  # its own copy beside the source says nothing that is not known
    beside = not distributed and _read_style(expander, name, ".cls", given)
    if not beside and not distributed and not name.startswith("\\"):  # \LoadClass{\@revtex@cls}
        expander.missing.setdefault(f"{name}.cls", expander.line(token.at)[1])
    if not beside or token.text == r"\LoadClass":
        expander.document_class = bare
    expander.document_class = expander.document_class or bare
    expander.counters.begin(bare)
    return True


def _preamble_of(expander: Expander, name: str) -> None:
    """The preamble of the main file of a subfile."""
    if name and expander.file is not None:
        file = name if name.endswith(".tex") else f"{name}.tex"
        above = (folder / file for folder in list(expander.file.absolute().parents)[:3])  # one is where TeX is called
        path = next((each for each in above if each.is_file()), None)
        if path is None:
            said = f"{file}, the main file, is missing: numbers are those that the source has by itself"
            expander.notes.append(said)
        else:
            preamble = read_text(path, "latin-1").partition(r"\begin{document}")[0]
            expander.document_class = ""
            expander.take_in(preamble, path)


FILES: dict[str, Primitive] = {
    **dict.fromkeys((r"\input", r"\include", r"\subfile", r"\subfileinclude", r"\@input"), _input),
    **dict.fromkeys((r"\import", r"\subimport", r"\subincludefrom", r"\includefrom"), _import),
    **dict.fromkeys((r"\usepackage", r"\RequirePackage"), _use),
    **dict.fromkeys((r"\documentclass", r"\LoadClass"), _class),
    **dict.fromkeys((r"\AtBeginDocument", r"\AtEndOfClass", r"\AtEndOfPackage"), _later),
    r"\endinput": _end_input,
    **dict.fromkeys((r"\SetupKeyvalOptions", r"\DeclareBoolOption", r"\DeclareStringOption"), _key_option),
    **dict.fromkeys((r"\PassOptionsToPackage", r"\PassOptionsToClass"), _pass_options),
    **dict.fromkeys((r"\DeclareOption", r"\ExecuteOptions", r"\ProcessOptions"), _option),
}
