/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

// All of this folder in one piece: the headers of OpenFOAM take longer to read than this code.

#include "oilLaws.C"
#include "Barus.C"
#include "Roelands.C"
#include "FVA3.C"
#include "freeVolume.C"
#include "DowsonHigginson.C"
#include "incompressible.C"
#include "Newtonian.C"
#include "Eyring.C"
#include "Carreau.C"
#include "limiting.C"
#include "lubricant.C"
#include "lawTable.C"
