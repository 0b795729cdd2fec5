"""Policies that choose among candidate grasps: how they are trained, kept, compared and used in a run."""
