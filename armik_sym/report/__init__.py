"""Figures of solved motions, drawn for clinicians and fit for print.

Nothing here touches pyplot: figures are plain objects, work without a display and leave nothing open.
"""

from armik_sym.report.hand_path_figure import hand_path_figure
from armik_sym.report.page import save_figure
from armik_sym.report.solution_figure import solution_figure

__all__ = ["hand_path_figure", "save_figure", "solution_figure"]
