"""The papers' equations, one by one: what is printed, what is true, and why."""
