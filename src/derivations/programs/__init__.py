"""Programs of regulators as data: statements, their order, their equivalence."""
