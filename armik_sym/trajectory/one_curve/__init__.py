"""The trajectory problem in one unknown per sample: the swivel angle."""
