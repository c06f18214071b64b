"""Other ways to integrate the same substeps, one a file; nothing outside the benchmark uses them."""
