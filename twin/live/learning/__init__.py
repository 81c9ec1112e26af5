"""The learned force and its bounded adaptation."""
