"""The report: one HTML file for a therapist and an engineer, with an arm that can be turned and played."""

from armik_sym.report.html.chapter import Chapter, chapter_of
from armik_sym.report.html.page import write_report

__all__ = ["Chapter", "chapter_of", "write_report"]
