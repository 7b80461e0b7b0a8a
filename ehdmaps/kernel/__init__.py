"""The equations in C99, one shared library of them, and how Python calls it.

Laws of contacts, films with memory, bearings and runs in time stand once, in the folder `c`: Python calls them through
`ctypes`, and exports write the same files, unchanged, with their numbers as data.

==============  ======================================================================================
library         finds the library, has it built where it does not fit the C files, and calls it
building        the C compiler; which state of the C files a library was made of (standard library only)
record          structs: numbers and arrays of Python as C sees them
==============  ======================================================================================

The C files in the order in which data pass through them; `kernel.c` includes all others and is what is compiled, as one
unit. So every `static` name is unique among all files. A public name begins with `ehd_`, and a public function takes a
pointer to its data first: C keeps no state of its own.

==============  ======================================================================================
numbers.h       what every part needs: statuses, the lesser and the greater of two numbers
kernel.c        the unit that is compiled
==============  ======================================================================================

Nothing is imported here: take the names from their modules.
"""
