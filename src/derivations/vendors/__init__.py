"""How the PID blocks of controllers in the field are written, each from the manual that was read, a file a vendor."""
