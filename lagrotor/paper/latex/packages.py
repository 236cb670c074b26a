r"""The commands of common packages as macros; their arguments are listed by the letters of \NewDocumentCommand."""

# Each line: commands, argument specification, definition. The commands under "" need no package.
TABLE = {
    "": r"""
        \bm,\pmb m \boldsymbol{#1}
        \ensuremath,\mathclap,\mathllap,\mathrlap,\smashoperator,\lefteqn,\Aboxed,\boxed,\fbox m #1
        \coloneqq - :=
        \eqqcolon - =:
        \vcentcolon - :
        \smash om #2
        \mspace,\phantom,\hphantom m \,
        \hspace sm \,
        \vspace sm
        \vphantom m
        \displaybreak,\allowdisplaybreaks o
        \raisetag,\noalign m
        \color om
        \textcolor omm #3
        \mathstrut,\displaylimits,\hfil -
        \mathchoice mmmm #1
        \lbrack - [
        \rbrack - ]
        \import mm \input{#1#2}
        \AtBeginDocument m #1
        \@power m \IfValueT{#1}{^{#1}}
        \@quotient mmmm \IfValueTF{#4}{\frac{#1\@power{#2} #3}{#1 #4\@power{#2}}}{\frac{#1\@power{#2} }{#1 #3\@power{#2}}}
        \@bracket mmm \IfValueT{#2}{\left#1 #2 \right#3}
        """,
    "physics": r"""
        \dv,\derivative somg \@quotient{\mathrm{d}}{#2}{#3}{#4}
        \pdv somgg \IfValueTF{#5}{\frac{\partial^{2} #3}{\partial #4 \partial #5}}{\@quotient{\partial}{#2}{#3}{#4}}
        \dd og \,\mathrm{d}\@power{#1} \IfValueT{#2}{#2}
        \qty sd()d[]d||g \@bracket({#2})\@bracket[{#3}]\@bracket|{#4}|\@bracket\{{#5}\}
        \pqty sm \left( #2 \right)
        \bqty sm \left[ #2 \right]
        \Bqty sm \left\{ #2 \right\}
        \abs,\absolutevalue,\vqty sm \left| #2 \right|
        \norm sm \left\| #2 \right\|
        \eval sm \left. #2 \right|
        \order sm \mathcal{O}\left(#2\right)
        \vb sm \mathbf{#2}
        \va sm \vec{\mathbf{#2}}
        \vu sm \hat{\mathbf{#2}}
        \vdot - \cdot
        \cross,\cp - \times
        \div g \nabla\cdot \IfValueT{#1}{#1}
        \var,\variation - \delta
        \qq sm \quad\text{#2}\quad
        \qc - ,\quad
        """,
}
for _name in ("and", "or", "if", "for", "with"):
    TABLE["physics"] += f"\\q{_name} - \\quad\\text{{{_name}}}\\quad\n"
for _name in "sin cos tan csc sec cot sinh cosh tanh arcsin arccos arctan exp log ln".split():  # noqa: SIM905
    TABLE["physics"] += f"\\{_name} o \\{_name}\\@power{{#1}}\n"
