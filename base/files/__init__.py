"""Files of people and of other programs: doors, formats, and checked values."""
