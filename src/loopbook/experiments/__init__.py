"""Experiments that tell what a tuning rule must know of a process, on simulated processes and on recorded data."""
