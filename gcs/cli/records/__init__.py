"""What commands about records share: which files, which options."""
