"""Draws the pictures of the README and of `docs/`; run it from the checkout: python docs/make_pictures.py."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

IMAGES = Path(__file__).resolve().parent / "images"

# Folder: (x, y, what it is), in the order in which code flows from bottom to top.
ROOMS = {
    "arm/": (0.5, 0.0, "DH chain, range of motion,\nlengths, catalogue, files"),
    "symbolic/": (0.0, 1.0, "CasADi expressions: pose,\nJacobians, closed forms"),
    "motion/": (1.0, 1.0, "hand paths and joint angles:\ncsv, bundled tasks"),
    "elbow/": (-0.55, 2.0, "device angles to\nhuman angles"),
    "compiled/": (0.0, 2.0, "C from expressions:\nemit, compile, cache, load"),
    "solution/": (1.0, 2.0, "angles that judge themselves:\nerrors, margins, verdict, files"),
    "pointwise/": (0.0, 3.0, "one pose after another:\nPro-ISADE, LM, Al-Faiz"),
    "trajectory/": (0.55, 3.0, "the whole path in one call:\nfirst guess, IPOPT problem"),
    "solving.py": (0.25, 4.0, "solve(arm, path, method)"),
    "report/": (1.0, 4.0, "figures"),
    "cli/": (0.6, 5.0, "the command armik"),
}
ARROWS = [
    ("arm/", "symbolic/"), ("symbolic/", "compiled/"), ("symbolic/", "elbow/"), ("arm/", "motion/"),
    ("motion/", "solution/"), ("compiled/", "trajectory/"), ("compiled/", "pointwise/"),
    ("solution/", "trajectory/"), ("solution/", "pointwise/"), ("trajectory/", "solving.py"),
    ("pointwise/", "solving.py"), ("solution/", "report/"), ("solving.py", "cli/"), ("report/", "cli/"),
]  # fmt: skip
WIDTH, HEIGHT = 0.44, 0.62


def architecture() -> Figure:
    """The folders and who uses whom."""
    figure = Figure(figsize=(10, 7.2), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    axes.set(xlim=(-0.82, 1.28), ylim=(-0.45, 5.5))
    for name, (x, y, text) in ROOMS.items():
        box = FancyBboxPatch(
            (x - WIDTH / 2, y - HEIGHT / 2), WIDTH, HEIGHT,
            boxstyle="round,pad=0,rounding_size=0.04", facecolor="#eef3f8", edgecolor="#33536e",
        )  # fmt: skip
        axes.add_patch(box)
        axes.text(x, y + 0.17, name, ha="center", va="center", weight="bold", size=11)
        axes.text(x, y - 0.1, text, ha="center", va="center", size=8.5, color="#333333")
    for below, above in ARROWS:
        (x0, y0, _), (x1, y1, _) = ROOMS[below], ROOMS[above]
        start, end = (x0, y0 + HEIGHT / 2), (x1, y1 - HEIGHT / 2)
        axes.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=12, color="#33536e"))
    return figure


def playing_ball() -> Figure:
    """The solved ball game (synthetic motion)."""
    import armik_sym as ak
    from armik_sym.report.solution_figure import solution_figure

    task = ak.load_task("playing_ball")
    solution = ak.solve(ak.catalog.ehmcs(), task.path, start=task.measured.q[0])
    return solution_figure(solution, measured=task.measured)


def main() -> None:
    """Write all pictures."""
    IMAGES.mkdir(exist_ok=True)
    architecture().savefig(IMAGES / "architecture.png", dpi=130)
    playing_ball().savefig(IMAGES / "playing_ball.png", dpi=110)


if __name__ == "__main__":
    main()
