"""Target `c`: a contact law and a bearing in C99, without a library.

The mathematics is that of `ehdmaps.kernel`, whose files `kernel` writes unchanged, with the numbers of one map as data;
the facades here give them the names that programs call. `text` writes
names, constants and tables.
"""
