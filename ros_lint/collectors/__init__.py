"""One module per format: each turns the text of a file into facts, and sees no other file."""
