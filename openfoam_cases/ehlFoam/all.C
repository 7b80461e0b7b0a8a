/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

// The rest in one piece: see the files of this name in the folders.

#include "report.C"
#include "caseFiles.C"
#include "ehlFoam.C"
