"""pid-report: Realisering och inställning av PID-regulatorer, J. Wahlfrid, 2007."""
