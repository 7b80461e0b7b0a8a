/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

// All of this folder in one piece: the headers of OpenFOAM take longer to read than this code.

#include "columnBlock.C"
#include "filmMesh.C"
#include "shearedColumn.C"
#include "filmFlow.C"
#include "thinFilm.C"
#include "fullStress.C"
