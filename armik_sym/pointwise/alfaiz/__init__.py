"""The method of Al-Faiz: every angle in closed form from one free number, and a search over that number."""

from armik_sym.pointwise.alfaiz.options import AlfaizOptions
from armik_sym.pointwise.alfaiz.run import run_alfaiz
from armik_sym.symbolic.alfaiz_closed_form import closed_form_fits

__all__ = ["AlfaizOptions", "closed_form_fits", "run_alfaiz"]
