"""Draws the pictures of the README and of `docs/`; run it from the checkout: python docs/make_pictures.py."""

from __future__ import annotations

import tempfile
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

IMAGES = Path(__file__).resolve().parent / "images"

# Folder: (x, y, what it is), in the order in which code flows from bottom to top.
ROOMS = {
    "arm/": (0.5, 0.0, "DH chain, range of motion,\nlengths, catalogue, files"),
    "symbolic/": (0.0, 1.0, "CasADi expressions: pose,\nJacobians, closed forms"),
    "motion/": (1.25, 1.0, "paths, angles, markers:\ncsv, trc, mot, c3d, bvh"),
    "elbow/": (-0.55, 2.0, "device angles to\nhuman angles"),
    "compiled/": (0.0, 2.0, "C from expressions:\nemit, compile, cache, load"),
    "solution/": (1.0, 2.0, "angles with errors,\nmargins, verdict, files"),
    "pointwise/": (0.0, 3.0, "one pose after another:\nPro-ISADE, LM, Al-Faiz"),
    "swivel/": (0.52, 3.0, "closed form, exact intervals,\nthe swivel map"),
    "trajectory/": (0.52, 4.0, "the whole path in one call:\nglobal search, IPOPT"),
    "fitting/": (2.2, 4.0, "an arm and its motion\nfrom recorded points"),
    "comparison/": (1.1, 3.0, "predicted motion\nover measured"),
    "servo/": (1.57, 3.0, "can the drives follow?\nre-timing"),
    "device/": (-0.55, 5.0, "the E-HMCS on a serial\nport: record, calibrate"),
    "solving.py": (0.1, 5.0, "solve(arm, path, method)"),
    "report/": (1.1, 4.0, "figures, the page with the\narm to turn and play"),
    "cli/": (0.6, 6.0, "the command armik"),
}
ARROWS = [
    ("arm/", "symbolic/"), ("symbolic/", "compiled/"), ("symbolic/", "elbow/"), ("arm/", "motion/"),
    ("motion/", "solution/"), ("compiled/", "swivel/"), ("compiled/", "pointwise/"),
    ("swivel/", "trajectory/"), ("swivel/", "report/"), ("solution/", "trajectory/"),
    ("solution/", "pointwise/"), ("trajectory/", "solving.py"), ("pointwise/", "solving.py"),
    ("swivel/", "fitting/"), ("motion/", "fitting/"), ("motion/", "servo/"), ("servo/", "report/"),
    ("solution/", "comparison/"), ("comparison/", "report/"), ("solving.py", "cli/"),
    ("report/", "cli/"), ("fitting/", "cli/"), ("elbow/", "device/"), ("device/", "cli/"),
]  # fmt: skip
WIDTH, HEIGHT = 0.44, 0.62


def architecture() -> Figure:
    """The folders and who uses whom."""
    figure = Figure(figsize=(13.6, 8.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    axes.set(xlim=(-0.82, 2.45), ylim=(-0.45, 6.45))
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


def swivel_map() -> Figure:
    """The swivel map of the ball catch (synthetic motion), solved in one piece and by Pro-ISADE."""
    import armik_sym as ak

    arm, task = ak.catalog.ehmcs(), ak.load_task("catching_ball")
    start = task.measured.q[0]
    solution = ak.solve(arm, task.path, start=start)
    others = {"Pro-ISADE": ak.solve(arm, task.path, "pro-isade", start=start), "measured": task.measured}
    return ak.swivel_map(arm, task.path).plot(solution, compare=others, title=task.title)


def swivel_map_patient() -> Figure:
    """A cup lifted with a stiff elbow (synthetic motion): samples without any posture."""
    import armik_sym as ak

    task = ak.load_task("drinking_lift")
    patient = ak.load_arm(Path(__file__).resolve().parents[1] / "data" / "patients" / "stroke_elbow.toml")
    title = f"{task.title}, elbow of a patient"
    return ak.swivel_map(patient, task.path).plot(compare={"without limits": task.measured}, title=title)


def swivel_circle() -> Figure:
    """One sample of a map in space: the elbow on its circle, and the part of it that limits allow."""
    import numpy as np

    import armik_sym as ak
    from armik_sym.report.stick_figure import stick_figure

    arm, task = ak.catalog.ehmcs(), ak.load_task("drinking_reach")
    one, branch, k = ak.swivel_map(arm, task.path), 2, 70
    line = np.array(task.path.position[k] - one.spherical.shoulder.centre)
    line /= np.linalg.norm(line)
    side = np.cross(line, arm.up)
    look = 0.75 * line - 0.66 * side / np.linalg.norm(side)
    look /= np.linalg.norm(look)
    up = arm.up - look * (look @ arm.up)
    up /= np.linalg.norm(up)
    view = np.column_stack([np.cross(look, up), up])

    def drawn(psi: float) -> np.ndarray:
        return stick_figure(arm, one.postures(psi, branch)[[k]]).points[0, :3] @ view

    figure = Figure(figsize=(7.2, 4.2), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    axes.set_aspect("equal")
    circle = np.array([drawn(psi)[1] for psi in np.linspace(0, 2 * np.pi, 181)])
    axes.plot(*circle.T, color="#999999", linewidth=1, linestyle="--")
    for start, end in one.intervals.of(k, branch):
        arc = np.array([drawn(psi)[1] for psi in np.linspace(start, end, 91)])
        axes.plot(*arc.T, color="#97BEDA", linewidth=7, solid_capstyle="butt", zorder=0)
    for psi, colour, width in ((0.0, "#AAAAAA", 2.5), (np.deg2rad(55), "#0072B2", 4.5)):
        axes.plot(*drawn(psi).T, color=colour, linewidth=width, marker="o", markersize=7, zorder=3)
    shoulder, elbow, wrist = drawn(np.deg2rad(55))
    axes.plot(*np.array([shoulder, wrist]).T, color="#1A1A1A", linewidth=1, linestyle=":")
    centre = 0.5 * (drawn(0.0)[1] + drawn(np.pi)[1])
    for psi, name in ((0.0, "g"), (0.5 * np.pi, "u")):
        tip = centre + 0.62 * (drawn(psi)[1] - centre)
        axes.annotate("", tip, centre, arrowprops={"arrowstyle": "-|>", "color": "#1A1A1A"})
        axes.annotate(
            name,
            tip,
            xytext=(-4, -15) if name == "g" else (-12, 4),
            textcoords="offset points",
            style="italic",
            size=11,
        )
    along = centre + 0.35 * (wrist - shoulder)
    axes.annotate("", along, centre, arrowprops={"arrowstyle": "-|>", "color": "#1A1A1A"})
    axes.annotate("ŵ", along, xytext=(4, 5), textcoords="offset points", style="italic", size=11)
    turn = centre + 0.4 * np.array([drawn(psi)[1] - centre for psi in np.linspace(0, np.deg2rad(55), 30)])
    axes.plot(*turn.T, color="#D55E00", linewidth=1.8)
    axes.annotate("ψ", turn[15], xytext=(-15, -4), textcoords="offset points", color="#D55E00", size=13)
    for point, name, aside in (
        (shoulder, "shoulder S", (8, 6)),
        (elbow, "elbow", (-44, -4)),
        (wrist, "wrist W", (8, -4)),
    ):
        axes.annotate(name, point, xytext=aside, textcoords="offset points", size=11)
    axes.annotate(
        "elbow at ψ = 0", drawn(0.0)[1], xytext=(-102, -10), textcoords="offset points", color="#777777"
    )
    return figure


def report_page(folder: Path) -> bytes:
    """The top of a report as a browser shows it (needs playwright and Chromium)."""
    import shutil

    from playwright.sync_api import sync_playwright

    import armik_sym as ak

    task = ak.load_task("drinking_lift")
    solution = ak.solve(ak.catalog.ehmcs(), task.path, start=task.measured.q[0])
    page_file = solution.report(folder / "report.html", measured=task.measured, servo=True, title=task.title)
    program = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1180, "height": 1530})
        page.goto(page_file.as_uri())
        page.evaluate("armik.ready()")
        page.evaluate("armik.setTime(1.9)")
        page.wait_for_timeout(1000)
        picture = page.screenshot()
        browser.close()
    return bytes(picture)


def main() -> None:
    """Write all pictures."""
    IMAGES.mkdir(exist_ok=True)
    architecture().savefig(IMAGES / "architecture.png", dpi=130)
    playing_ball().savefig(IMAGES / "playing_ball.png", dpi=110)
    swivel_map().savefig(IMAGES / "swivel_map.png", dpi=130)
    swivel_map_patient().savefig(IMAGES / "swivel_map_patient.png", dpi=110)
    swivel_circle().savefig(IMAGES / "swivel_circle.png", dpi=110)
    with tempfile.TemporaryDirectory() as folder:
        (IMAGES / "report.png").write_bytes(report_page(Path(folder)))


if __name__ == "__main__":
    main()
