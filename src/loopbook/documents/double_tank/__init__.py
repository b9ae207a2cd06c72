"""double-tank: the Swedish laboratory report on two tanks with a transport delay."""
