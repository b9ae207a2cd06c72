"""In time: the closed loop's equations, simulation with limits, step metrics."""
