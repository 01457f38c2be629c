# SPDX-License-Identifier: MIT
"""How objects of the compiled module come back from a pickle: made whole, never by __new__ alone."""
from . import _core


def restored(kind, state):
    """The object of that class with that state."""
    return getattr(_core, kind)._of_state(state)
