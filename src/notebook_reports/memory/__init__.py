"""What is remembered between builds: stamps, fingerprints, the manifest."""
