"""What every room uses: files, text, the machine and numbers; knows nothing of grasps.

Its modules are imported one by one, so that light commands start without the heavy ones.
"""
