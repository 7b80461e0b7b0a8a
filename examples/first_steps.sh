#!/usr/bin/env bash
# First steps with an own bearing and an own machine, with every command. From a fresh clone, after the set-up
#
#     bash .ci/environment && . .venv/bin/activate
#
# run this in an empty folder: bash PATH/TO/examples/first_steps.sh. Some minutes, about one of them to compile film solvers once.
set -euo pipefail

# Own bearing: designation and viscosity class are enough; what is estimated is marked, with its effect.
ehdmaps check --bearing NU210 --oil "ISO VG 46"                                  # what will be made, and how sure it is
ehdmaps generate --bearing NU210 --oil "ISO VG 46"                               # NU210_ISO_VG_46.nc, in seconds
ehdmaps report NU210_ISO_VG_46.nc -o bearing.html                                # one page to send
mbs bearing NU210 --oil "ISO VG 46" --load "5 kN" --speed "1500 rpm" --plot bearing.png
ehdmaps export NU210_ISO_VG_46.nc --to fmu -o NU210.fmu                          # for another simulator; needs gcc

# Own machine: a commented scene, to be edited; it runs as it is.
mbs new shaft -o mine.toml
mbs check mine.toml                                                             # every problem, and what will be solved
mbs run mine.toml -o results                                                    # every analysis it has a table for
mbs report mine.toml -o mine.html
