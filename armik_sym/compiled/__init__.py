"""C from expressions: generate, compile, cache, load, and export for a robot controller."""

from armik_sym.compiled.kinematics import Kinematics, compile

__all__ = ["Kinematics", "compile"]
