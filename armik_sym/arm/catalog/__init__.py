"""The arms of the papers, ready to use."""

from armik_sym.arm.catalog.alfaiz import alfaiz
from armik_sym.arm.catalog.ehmcs import ehmcs
from armik_sym.arm.catalog.human import human
from armik_sym.arm.catalog.lookup import by_name, names

__all__ = ["alfaiz", "by_name", "ehmcs", "human", "names"]
