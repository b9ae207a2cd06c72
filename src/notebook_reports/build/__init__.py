"""Building: what is to be done, jobs, the judgement at the end, watching, verifying."""
