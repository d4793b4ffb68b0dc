"""The kinematics inside the HTML report: generated C as WebAssembly, or frames computed beforehand."""

from armik_sym.report.wasm.page_kinematics import PageKinematics, page_kinematics

__all__ = ["PageKinematics", "page_kinematics"]
