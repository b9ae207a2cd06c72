"""PID laws, their terms, filters and update laws."""
