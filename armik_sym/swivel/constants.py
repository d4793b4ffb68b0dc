"""Numbers that decide in the closed form over the swivel angle; NumPy and C take them from here."""

from __future__ import annotations

import numpy as np

TURN = 2 * np.pi

# By how much an angle may leave the range for rounding, in [rad].
ROUNDING = 1e-12

# By how much a target may be out of reach for rounding, in [m].
REACH = 1e-9

# sin²β below which the outer two of three axes are parallel.
POLE = 1e-26

# sin²β below which somebody might ask who takes which share of α ± γ: above `POLE`.
NEAR = 1e-20

# Sine of an angle below which the outer axes count as parallel for every ψ.
PARALLEL = 1e-13

# Joints that miss their limits by the same within this: the first one is named, in [rad].
TIE = 1e-8

# Bisections for what is missing: from π to below 1e-10 rad.
ROUNDS = 36
