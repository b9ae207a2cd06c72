"""What experiments on a process tell, in symbols."""
