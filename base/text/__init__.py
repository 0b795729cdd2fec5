"""What is said to people: consoles, tables, spelling, notebooks."""
