"""Many jobs: one after the other, in threads, in processes here, on Dask's workers, behind one interface."""
