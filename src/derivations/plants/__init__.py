"""Plants from balances."""
