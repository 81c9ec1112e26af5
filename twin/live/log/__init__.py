"""MCAP: written while the ship sails, recovered after a crash, read again."""
