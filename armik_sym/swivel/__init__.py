"""The swivel angle: closed-form inverse kinematics of arms with spherical shoulder and wrist, and limits."""
