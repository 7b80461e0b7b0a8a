"""One module a command of `mbs`; each has ``run(arguments) -> (text for stdout, exit status)``."""
