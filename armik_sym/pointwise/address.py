"""Arrays as C sees them, under the name the pointwise methods use."""

from __future__ import annotations

from armik_sym.compiled.address import address

__all__ = ["address"]
