"""Beyond one PID: what a predictor, a second measurement, a measured disturbance, a schedule bring, in numbers."""
