"""The pages over all reports: the map, the ledger, the book."""
