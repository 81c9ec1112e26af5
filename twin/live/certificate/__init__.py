"""The proof that the observer's error stays bounded, and the live bound."""
