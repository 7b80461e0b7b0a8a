"""One module a command of `ehdmaps`; each has ``run(arguments) -> (text for stdout, exit status)``."""
