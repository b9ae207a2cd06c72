"""Sampled models in symbols."""
