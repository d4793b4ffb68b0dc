"""The expressions behind it all: build your own quantity on top of an arm."""

from __future__ import annotations

import casadi as ca
import numpy as np

import armik_sym as ak


def main() -> int:
    """Manipulability of the wrist, its gradient, and a check of the Jacobian by automatic differentiation."""
    expressions = ak.symbolic.express(ak.catalog.ehmcs(), lengths="baked")
    q, J = expressions.q, expressions.jacobian[:3, :]

    manipulability = ca.sqrt(ca.det(J @ J.T))
    gradient = ca.gradient(manipulability, q)
    function = ca.Function("manipulability", [q], [manipulability, gradient], ["q"], ["w", "dw_dq"])

    posture = np.deg2rad([20, 30, 10, 80, 0, 0, 0])
    w, dw = function(posture)
    print(f"manipulability {float(w):.5f} m³, gradient {np.asarray(dw).ravel().round(4)}")

    by_autodiff = ca.Function("J", [q], [ca.jacobian(expressions.position, q)])
    geometric = ca.Function("J", [q], [J])
    print(f"Jacobian: {abs(np.asarray(by_autodiff(posture) - geometric(posture))).max():.1e} from autodiff")
    return 0


if __name__ == "__main__":
    main()
