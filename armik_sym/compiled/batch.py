"""Evaluating a function of (q, lengths) for one posture or many, without a Python loop."""

from __future__ import annotations

import ctypes
import functools
import threading
from collections.abc import Callable
from typing import Any, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from armik_sym.compiled.build import Library

Array = NDArray[np.float64]


class PostureFunction(Protocol):
    """A function of the posture; segment lengths are fixed."""

    def one(self, q: Array) -> Array:
        """Evaluate one posture (dof,): a new array (size,)."""

    def many(self, q: Array, out: Array | None = None) -> Array:
        """Evaluate postures (n, dof) into `out` (n, size), or into a new array."""


class _Scratch(threading.local):
    """Buffers and the call that uses them, one set per thread: finding an address costs more than a call."""

    def __init__(self, loop: Callable[..., None], lengths: Array, dof: int, size: int) -> None:
        self.q = np.empty(dof)
        self.out = np.empty(size)
        addresses = (ctypes.c_void_p(array.ctypes.data) for array in (self.q, lengths, self.out))
        self.run = functools.partial(loop, ctypes.c_ssize_t(1), *addresses)


class CompiledFunction:
    """A loop in generated C: out_i = f(q_i, lengths)."""

    def __init__(self, library: Library, function: ca.Function, lengths: Array) -> None:
        self._library = library
        self._loop = getattr(library.handle, f"armik_{function.name()}_batch")
        self._loop.restype = None
        self._loop.argtypes = [ctypes.c_ssize_t, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
        self._lengths = lengths
        self._lengths_address = lengths.ctypes.data
        self._size = function.numel_out(0)
        self._scratch = _Scratch(self._loop, lengths, function.numel_in(0), self._size)

    def one(self, q: Array) -> Array:
        """Evaluate one posture (dof,): a new array (size,)."""
        scratch = self._scratch
        scratch.q[:] = q
        scratch.run()
        return scratch.out.copy()

    def many(self, q: Array, out: Array | None = None) -> Array:
        """Evaluate postures (n, dof) into `out` (n, size), or a new array; releases the interpreter lock."""
        if out is None:
            out = np.empty((len(q), self._size))
        self._loop(len(q), q.ctypes.data, self._lengths_address, out.ctypes.data)
        return out


class VirtualMachineFunction:
    """The same through CasADi's virtual machine, in blocks that CasADi loops over itself."""

    _BLOCK = 256

    def __init__(self, function: ca.Function, lengths: Array) -> None:
        self._single = function
        self._block = function.map("block", "serial", self._BLOCK, [1], [])
        self._lengths = lengths
        self._size = function.numel_out(0)

    def one(self, q: Array) -> Array:
        """Evaluate one posture (dof,): a new array (size,)."""
        out = np.empty(self._size)
        self._call(self._single, q, out)
        return out

    def many(self, q: Array, out: Array | None = None) -> Array:
        """Evaluate postures (n, dof) into `out` (n, size), or into a new array."""
        if out is None:
            out = np.empty((len(q), self._size))
        whole = len(q) - len(q) % self._BLOCK
        for start in range(0, whole, self._BLOCK):
            part = slice(start, start + self._BLOCK)
            self._call(self._block, q[part], out[part])
        for i in range(whole, len(q)):
            self._call(self._single, q[i], out[i])
        return out

    def _call(self, function: Any, q: Array, out: Array) -> None:
        buffer, run = function.buffer()
        buffer.set_arg(0, q.data)
        if self._lengths.size:
            buffer.set_arg(1, self._lengths.data)
        buffer.set_res(0, out.data)
        run()
