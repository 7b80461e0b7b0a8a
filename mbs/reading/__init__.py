"""Reading scene files, a kind of table a module."""
