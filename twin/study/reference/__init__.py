"""What healthy voyages establish, for every verb that judges another one."""
