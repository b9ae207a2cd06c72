"""What an answer can be; a file each."""
