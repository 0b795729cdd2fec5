"""What is proved, and the equations behind it."""
