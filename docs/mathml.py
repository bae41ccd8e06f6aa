"""Formulas of the site as MathML, by the converter of docutils: no script, nothing to fetch."""

from __future__ import annotations

import html
import re
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
_BRACKETS = ("\u27e8", "\u27e9", "\u2329", "\u232a")  # angle brackets
_NAMED = re.compile(r"&(?!amp;|lt;|gt;|#)\w+;")


def mathml(text: str, block: bool) -> str:
    """Formula as MathML.

    Parameters
    ----------
    text : str
        Formula in the language of TeX.
    block : bool
        Whether it stands on lines of its own.

    Returns
    -------
    str
        Element of MathML.
    """
    ElementTree.register_namespace("", NAMESPACE)
    # Names of characters are HTML's; XML knows those of its markup alone.
    converted = _NAMED.sub(lambda name: html.unescape(name[0]), tex2mathml(text, as_block=block))
    root = ElementTree.fromstring(converted)
    for accented in list(root.iter(f"{{{NAMESPACE}}}munderover")):
        base, index, accent = accented
        if not base.tag.endswith("}mi"):
            continue  # a sum with its limits
        # The converter takes the index of an accented letter for a limit and puts it below.
        accented.tag = f"{{{NAMESPACE}}}msub"
        letter = ElementTree.Element(f"{{{NAMESPACE}}}mover", accent="true")
        letter.extend([base, accent])
        accented[:] = [letter, index]
    for operator in root.iter(f"{{{NAMESPACE}}}mo"):
        if operator.text in _BRACKETS:  # of a mean: as high as a letter, not as the whole line
            operator.set("stretchy", "false")
    return ElementTree.tostring(root, encoding="unicode")


def _mathml(node: nodes.Element, block: bool) -> str:
    try:
        return mathml(node.astext(), block)
    except (MathError, SyntaxError) as error:
        raise ExtensionError(f"formula {node.astext()!r}: {error}") from error


def _visit_math(writer: Any, node: nodes.Element) -> None:
    writer.body.append(_mathml(node, block=False))
    raise nodes.SkipNode


def _visit_displaymath(writer: Any, node: nodes.Element) -> None:
    number = ""
    if node["number"]:
        number = f'<span class="eqno">({node["number"]})</span>'
    name = f' id="{node["ids"][0]}"' if node["ids"] else ""
    writer.body.append(f'<div class="math"{name}>{number}{_mathml(node, block=True)}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Make MathML the way formulas are written."""
    app.add_html_math_renderer("mathml", (_visit_math, None), (_visit_displaymath, None))
    app.config.html_math_renderer = "mathml"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
