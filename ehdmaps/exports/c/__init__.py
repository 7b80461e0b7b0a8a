"""Target `c`: a contact law and a bearing in C99, without a library.

The files `*.h` and `*.c` here are the law's mathematics in C, as `ehdmaps.maps.kernels` and `mbs.bearings` have it in
Python; `kernel` puts them together with the numbers of one map, `locked_table` with what it says of the locked film;
`text` writes names, constants and tables.
"""
