"""Many ships and many voyages: listed, asked in processes of their own, kept as rows, ranked by what is
wrong."""
