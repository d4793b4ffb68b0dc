"""Whole-trajectory inverse kinematics of the human arm."""

from armik_sym._version import __version__
