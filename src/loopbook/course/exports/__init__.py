"""Sheets for other systems: Moodle, GIFT, CSV, nbgrader, otter. Each is a weaker check than `loopbook course grade`."""
