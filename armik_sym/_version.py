"""The version of the package, read by the build and by emitted C code."""

__version__ = "0.1.0"
