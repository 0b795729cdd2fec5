"""Many grasps at once: data sets, batches, tables, and files of other programs."""
