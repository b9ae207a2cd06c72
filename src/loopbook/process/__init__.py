"""What is controlled: transfer functions with exact dead time, their frequency response, their sampled form."""
