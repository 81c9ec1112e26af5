"""The source paper's tables and figures, reproduced."""
