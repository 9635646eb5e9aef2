"""The result page of a study: plain HTML from templates, with the numbers of the atlas inside."""
