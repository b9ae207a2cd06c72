"""What serves one document only, a folder each, with what it prints as data."""
