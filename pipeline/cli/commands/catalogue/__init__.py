"""What is built in, and files of the same kinds."""
