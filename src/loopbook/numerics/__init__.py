"""Numbers without control: exact fractions, polynomials, state space, signals, delay equations."""
