/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

// All of this folder in one piece: the headers of OpenFOAM take longer to read than this code.

#include "pointContact.C"
#include "pointLayout.C"
#include "pointSolid.C"
#include "pointFilm.C"
#include "pointTangent.C"
#include "pointNewton.C"
#include "pointMesh.C"
#include "solvePoint.C"
