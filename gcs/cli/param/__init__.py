"""`gcs param`: the parameters of the vehicle, and files of them."""
