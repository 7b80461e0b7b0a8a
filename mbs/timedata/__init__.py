"""Time data of runs, simulated or measured: in, out, and with the speed that belongs to them.

===========  ====================================================================================
records      channels over time and their units, with speed and angle where they are known
csv_file     tables of numbers with names and units in their first line
uff_file     universal files, datasets 58
wav_file     sound files with a table that says the scale; one to listen to
netcdf_file  results of `mbs runup`, and signals alone
speed        speed and angle of a record: a channel, pulses of a tacho, a table
===========  ====================================================================================

`mbs.output.time_files` reads and writes them by the ending of a name.
"""
