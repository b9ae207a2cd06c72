"""All loops of a plant: one design for each record, and a summary of what needs attention."""
