"""The stages chained: task in, run folder out; command line, report and Gymnasium environment."""
