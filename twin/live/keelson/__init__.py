"""The bus: Keelson keys, envelopes and types, and Zenoh."""
