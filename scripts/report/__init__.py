"""One self-contained HTML page about a calibration or a single simulated cut."""
