"""From a task to grasps, stage by stage."""
