"""Jobs about what a vehicle keeps: its parameters, files and logs.  None of them moves it."""
