"""From a recorded experiment to a process model: read the record, find the steps, fit models, choose one."""
