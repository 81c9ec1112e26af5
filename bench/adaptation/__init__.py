"""Laws of adaptation side by side."""
