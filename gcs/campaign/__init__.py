"""Many flights of the whole station on a virtual clock: chosen, flown, judged by the truth, told.

`spec.py` reads the file, `sampling.py` and `search.py` choose, `flight.py` flies one row,
`truth.py` judges it, `statistics.py` and `page.py` tell of all.  `engine.py` hands rows to Dask's
workers, `store.py` keeps them; both libraries are of the extra `campaign` and imported there alone.
"""
