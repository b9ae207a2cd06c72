"""From what students handed in to verdicts, feedback and grades."""
