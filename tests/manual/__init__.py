"""Pages of keys and commands, made of the code that reads them: `python -m tests.manual` compares or rewrites them.

`recording` notes which keys the readers of jobs and scenes ask for, and what they allow; `probes` has texts that
reach all of them. The words on each key stand in `docs/job_keys.toml` and `docs/scene_keys.toml`. `keys` puts both
together, `commands` writes what --help says.
"""
