"""Every reader of both packages given damaged files: what is read is right, what is refused is refused in words.

===============  ====================================================================
damage           how good files are damaged
search           a reader given damaged files, in child processes that may crash
map_readers      jobs, maps, stores and statuses of runs, damaged
machine_readers  scenes, bodies of finite elements and measured records, damaged
===============  ====================================================================

The tests give each reader forty files; `python -m tests.fuzzing` as many as are asked for.
"""
