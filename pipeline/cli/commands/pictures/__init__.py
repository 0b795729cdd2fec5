"""Pages and pictures of what there is and what was found."""
