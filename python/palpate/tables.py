"""Shows an object in a notebook as a table of its properties."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

_WHOLE = 9  # numbers of the largest array that is shown itself: vectors, not images (judgement)


def _words(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > _WHOLE:
        return f"{value.dtype} {value.shape}"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def table(thing: Any) -> str:
    """Name, value and meaning of each property, in HTML."""
    facts = {name: fact for name, fact in vars(type(thing)).items() if isinstance(fact, property)}
    if "positions" in facts:
        del facts["points"]  # it would copy them all
    rows = ((name, _words(getattr(thing, name)), fact.__doc__ or "") for name, fact in facts.items())
    lines = ("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<p>{escape(repr(thing))}</p><table>{''.join(lines)}</table>"
