"""A first model of a ship from its main particulars, by published regressions."""
