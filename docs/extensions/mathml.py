"""Formulas as MathML, which browsers draw by themselves: no script, no font from elsewhere."""

from __future__ import annotations

import re
from html import unescape
from typing import Any
from xml.etree import ElementTree as ET

from docutils import nodes
from docutils.utils.math import MathError, pick_math_environment
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

_NAMESPACE = ' xmlns="http://www.w3.org/1998/Math/MathML"'
"""HTML needs none."""
_ACCENTS = "~ˆ^ˉ¯→˙¨"
_logger = logging.getLogger(__name__)


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the renderer `mathml`; its translation from TeX is that of docutils."""
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: HTML5Translator, node: nodes.math) -> None:
    writer.body.append(_translated(node, node.astext(), block=False))
    raise nodes.SkipNode


def _displayed(writer: HTML5Translator, node: nodes.math_block) -> None:
    text = node.astext()
    if pick_math_environment(text).startswith("align"):  # More than one line, or a & to align at.
        text = rf"\begin{{align*}}{text}\end{{align*}}"
    writer.body.append(f'<div class="math">{_translated(node, text, block=True)}</div>\n')
    raise nodes.SkipNode


def _translated(node: nodes.Element, text: str, *, block: bool) -> str:
    try:
        return _accents_above(tex2mathml(text, as_block=block))
    except MathError as error:
        _logger.warning("no MathML for %r: %s", text, error, location=node)
        return ""


def _accents_above(mathml: str) -> str:
    r"""Sets the index of an accented letter beside it, where docutils sets it below.

    Example:
        >>> below = r"<math><munderover><mi>x</mi><mi>i</mi><mo>~</mo></munderover></math>"
        >>> _accents_above(below)
        '<math><msub><mover accent="true"><mi>x</mi><mo>~</mo></mover><mi>i</mi></msub></math>'
    """
    plain = re.sub(r"&(?!lt;|gt;|amp;)\w+;", lambda name: unescape(name[0]), mathml)  # For XML.
    tree = ET.fromstring(plain.replace(_NAMESPACE, ""))  # noqa: S314 - docutils wrote it.
    for found in list(tree.iter("munderover")):
        letter, index, above = found
        if (above.text or "") not in _ACCENTS:
            continue
        accented = ET.Element("mover", accent="true")
        accented.extend([letter, above])
        found[:] = [accented, index]
        found.tag, found.attrib = "msub", {}
    return ET.tostring(tree, encoding="unicode")
