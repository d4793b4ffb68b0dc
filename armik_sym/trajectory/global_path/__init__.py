"""The shortest path through the swivel map: which branch and which corridor, for the whole path at once."""
