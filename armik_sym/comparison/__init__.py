"""How far a solved motion is from what a person really did."""

from armik_sym.comparison.comparing import compare
from armik_sym.comparison.comparison import Comparison
from armik_sym.comparison.constant_swivel import constant_swivel
from armik_sym.comparison.difference import Difference
from armik_sym.comparison.predicting import predict, predictors

__all__ = ["Comparison", "Difference", "compare", "constant_swivel", "predict", "predictors"]
