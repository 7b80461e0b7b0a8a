/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "columnBlock.H"
#include "polyPatch.H"

Foam::autoPtr<Foam::fvMesh> Foam::columnBlock(const Time& runTime, const label columns, const label rows)
{
    auto point = [&](const label k, const label side, const label j)
    {
        return columnBlockPoint(rows, k, side, j);
    };
    pointField points(2*(columns + 1)*(rows + 1));
    for (label k = 0; k <= columns; ++k)
    {
        for (label side = 0; side < 2; ++side)
        {
            for (label j = 0; j <= rows; ++j) points[point(k, side, j)] = vector(k, j, side);
        }
    }

    // normals out of the owner, which is the cell of the lower number
    auto alongX = [&](const label k, const label j)
    {
        return face({point(k, 0, j), point(k, 0, j + 1), point(k, 1, j + 1), point(k, 1, j)});
    };
    auto alongY = [&](const label i, const label j)
    {
        return face({point(i, 0, j), point(i, 1, j), point(i + 1, 1, j), point(i + 1, 0, j)});
    };
    auto alongZ = [&](const label i, const label side, const label j)
    {
        return face({point(i, side, j), point(i + 1, side, j), point(i + 1, side, j + 1), point(i, side, j + 1)});
    };
    DynamicList<face> faces;
    DynamicList<label> owner, neighbour;
    auto add = [&](const label cell, const face& f)
    {
        owner.append(cell);
        faces.append(f);
    };
    for (label i = 0; i < columns; ++i)
    {
        for (label j = 0; j < rows; ++j)
        {
            const label cell = i*rows + j;
            if (j + 1 < rows)
            {
                add(cell, alongY(i, j + 1));
                neighbour.append(cell + 1);
            }
            if (i + 1 < columns)
            {
                add(cell, alongX(i + 1, j));
                neighbour.append(cell + rows);
            }
        }
    }
    const wordList names({"inlet", "outlet", "lower", "upper", "frontAndBack"});
    const wordList types({"patch", "patch", "wall", "wall", "empty"});
    labelList starts(names.size());
    starts[0] = faces.size();
    for (label j = 0; j < rows; ++j) add(j, alongX(0, j).reverseFace());
    starts[1] = faces.size();
    for (label j = 0; j < rows; ++j) add((columns - 1)*rows + j, alongX(columns, j));
    starts[2] = faces.size();
    for (label i = 0; i < columns; ++i) add(i*rows, alongY(i, 0).reverseFace());
    starts[3] = faces.size();
    for (label i = 0; i < columns; ++i) add(i*rows + rows - 1, alongY(i, rows));
    starts[4] = faces.size();
    for (label side = 0; side < 2; ++side)
    {
        for (label i = 0; i < columns; ++i)
        {
            for (label j = 0; j < rows; ++j)
            {
                const face f(alongZ(i, side, j));
                add(i*rows + j, side ? f : f.reverseFace());
            }
        }
    }
    const label all = faces.size();

    faceList faceField(std::move(faces));
    labelList owners(std::move(owner)), neighbours(std::move(neighbour));
    autoPtr<fvMesh> mesh
    (
        new fvMesh
        (
            IOobject(fvMesh::defaultRegion, runTime.constant(), runTime, IOobject::NO_READ, IOobject::AUTO_WRITE),
            std::move(points), std::move(faceField), std::move(owners), std::move(neighbours)
        )
    );
    // a mesh from memory does not look for its schemes and its solution by itself
    mesh->fvSchemes::readOpt() = IOobject::MUST_READ;
    mesh->fvSchemes::read();
    mesh->fvSolution::readOpt() = IOobject::MUST_READ;
    mesh->fvSolution::read();
    List<polyPatch*> patches(names.size());
    forAll(names, p)
    {
        const label end = p + 1 < names.size() ? starts[p + 1] : all;
        patches[p] =
            polyPatch::New(types[p], names[p], end - starts[p], starts[p], p, mesh->boundaryMesh()).release();
    }
    mesh->addFvPatches(patches);
    return mesh;
}
