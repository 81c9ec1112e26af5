"""`twin view`: what the twin says, for the people on the bridge, in a browser or in a terminal; a process of
its own."""
