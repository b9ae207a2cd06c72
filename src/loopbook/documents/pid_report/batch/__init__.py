"""The batch of test processes behind AMIGO."""
