"""Commands on scene files themselves: a new one, and a check of one."""
