/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "filmMesh.H"
#include "linear.H"
#include "zeroGradientFvPatchFields.H"
#include "fixedValueFvPatchFields.H"
#include "emptyFvPatchFields.H"

Foam::filmMesh::filmMesh
(
    fvMesh& mesh,
    const label columns,
    const label rows,
    const scalar lowerShare
)
:
    mesh_(mesh),
    columns_(columns),
    rows_(rows),
    lowerShare_(lowerShare),
    level_(rows + 1),
    x_(columns + 1, Zero),
    h_(columns + 1, Zero),
    columnFace_(mesh.nInternalFaces(), -1),
    faceRow_(mesh.nInternalFaces(), -1),
    acrossFilm
    (
        IOobject("acrossFilm", mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::NO_WRITE),
        mesh,
        dimensionedScalar("one", dimless, 1)
    )
{
    if (rows < 2)
    {
        FatalErrorInFunction << "rows: got " << rows << ", allowed are 2 and more" << exit(FatalError);
    }
    if (mesh.nCells() != columns*rows || mesh.nPoints() != 2*(columns + 1)*(rows + 1))
    {
        FatalErrorInFunction
            << "the mesh has " << mesh.nCells() << " cells and " << mesh.nPoints()
            << " points, not those of " << columns << " columns of " << rows
            << " cells; run blockMesh with the same columns and rows" << exit(FatalError);
    }
    for (const word patch : {"inlet", "outlet", "lower", "upper"})
    {
        if (mesh.boundaryMesh().findPatchID(patch) < 0)
        {
            FatalErrorInFunction << "the mesh has no patch " << patch << exit(FatalError);
        }
    }

    const scalarField z(mesh.points().component(vector::Z));
    depth = max(z) - min(z);
    forAll(level_, j)
    {
        level_[j] = scalar(j)/rows;
    }

    forAll(columnFace_, face)
    {
        const label owner = mesh.owner()[face], neighbour = mesh.neighbour()[face];
        if (owner/rows != neighbour/rows)
        {
            columnFace_[face] = neighbour/rows;
            faceRow_[face] = owner % rows;
            acrossFilm[face] = 0;
        }
    }
    acrossFilm.boundaryFieldRef()[inlet()] = 0.0;
    acrossFilm.boundaryFieldRef()[outlet()] = 0.0;
}


void Foam::filmMesh::move(const scalarField& x, const scalarField& h)
{
    if (x_ == x && h_ == h)
    {
        return;
    }
    x_ = x;
    h_ = h;
    pointField points(mesh_.nPoints());
    label point = 0;
    forAll(x, k)
    {
        for (label side = 0; side < 2; ++side)
        {
            forAll(level_, j)
            {
                points[point++] = vector(x[k], (level_[j] - lowerShare_)*h[k], side*depth);
            }
        }
    }
    mesh_.movePoints(points);
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmMesh::sweptFlux
(
    const scalarField& xRate,
    const scalarField& hRate
) const
{
    auto tflux = tmp<surfaceScalarField>::New
    (
        IOobject("sweptFlux", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedScalar("zero", dimVolume/dimTime, 0)
    );
    surfaceScalarField& flux = tflux.ref();
    flux.setOriented();

    // mean velocity of the two edges of a face between rows
    auto acrossVelocity = [&](const label column, const scalar level)
    {
        return 0.5*vector
        (
            xRate[column] + xRate[column + 1],
            (level - lowerShare_)*(hRate[column] + hRate[column + 1]),
            0
        );
    };
    forAll(columnFace_, face)
    {
        const vector& area = mesh_.Sf()[face];
        const label owner = mesh_.owner()[face], k = columnFace_[face];
        flux[face] = k < 0
          ? area & acrossVelocity(owner/rows_, level_[owner % rows_ + 1])
          : area.x()*xRate[k];
    }
    for (const label patch : {lower(), upper()})
    {
        const labelUList& cells = mesh_.boundary()[patch].faceCells();
        forAll(cells, i)
        {
            flux.boundaryFieldRef()[patch][i] =
                mesh_.Sf().boundaryField()[patch][i]
              & acrossVelocity(cells[i]/rows_, patch == upper() ? 1 : 0);
        }
    }
    flux.boundaryFieldRef()[inlet()] =
        mesh_.Sf().boundaryField()[inlet()].component(vector::X)*xRate[0];
    flux.boundaryFieldRef()[outlet()] =
        mesh_.Sf().boundaryField()[outlet()].component(vector::X)*xRate[columns_];
    return tflux;
}


Foam::tmp<Foam::scalarField> Foam::filmMesh::volumeRate
(
    const scalarField& xRate,
    const scalarField& hRate
) const
{
    auto trate = tmp<scalarField>::New(mesh_.nCells());
    scalarField& rate = trate.ref();
    for (label i = 0; i < columns_; ++i)
    {
        const scalar area =
            0.5*(hRate[i] + hRate[i + 1])*length(i) + film(i)*(xRate[i + 1] - xRate[i]);
        for (label j = 0; j < rows_; ++j)
        {
            rate[cell(i, j)] = share(j)*depth*area;
        }
    }
    return trate;
}


Foam::scalarField Foam::filmMesh::surfaceSlope(const scalar level) const
{
    scalarField slope(columns_);
    forAll(slope, i)
    {
        slope[i] = (level - lowerShare_)*(h_[i + 1] - h_[i])/length(i);
    }
    return slope;
}


Foam::scalarField Foam::filmMesh::surfaceRate
(
    const scalar level,
    const scalarField& xRate,
    const scalarField& hRate
) const
{
    scalarField rate(columns_);
    const scalarField slope(surfaceSlope(level));
    forAll(rate, i)
    {
        rate[i] = 0.5*(level - lowerShare_)*(hRate[i] + hRate[i + 1])
          - 0.5*(xRate[i] + xRate[i + 1])*slope[i];
    }
    return rate;
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmMesh::carriedSmooth
(
    const volScalarField& field,
    const scalar inletValue
) const
{
    tmp<surfaceScalarField> tface(linear<scalar>(mesh_).interpolate(field));
    surfaceScalarField& value = tface.ref();
    auto centre = [&](const label i) { return 0.5*(x_[i] + x_[i + 1]); };
    forAll(columnFace_, face)
    {
        const label k = columnFace_[face];
        if (k < 2) continue;
        const label row = faceRow_[face];
        const scalar a = centre(k - 2), b = centre(k - 1), c = centre(k), x = x_[k];
        value[face] =
            (x - b)*(x - c)/((a - b)*(a - c))*field[cell(k - 2, row)]
          + (x - a)*(x - c)/((b - a)*(b - c))*field[cell(k - 1, row)]
          + (x - a)*(x - b)/((c - a)*(c - b))*field[cell(k, row)];
    }
    value.boundaryFieldRef()[inlet()] = inletValue;
    return tface;
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmMesh::carriedSharp
(
    const volScalarField& field,
    const scalar inletValue
) const
{
    tmp<surfaceScalarField> tface(linear<scalar>(mesh_).interpolate(field));
    surfaceScalarField& value = tface.ref();
    forAll(columnFace_, face)
    {
        const label k = columnFace_[face];
        if (k > 0) value[face] = field[cell(k - 1, faceRow_[face])];
    }
    value.boundaryFieldRef()[inlet()] = inletValue;
    return tface;
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmMesh::acrossGradient
(
    const volScalarField& field
) const
{
    auto tgradient = tmp<surfaceScalarField>::New
    (
        IOobject("acrossGradient", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedScalar("zero", field.dimensions()/dimLength, 0)
    );
    surfaceScalarField& gradient = tgradient.ref();
    forAll(columnFace_, face)
    {
        if (columnFace_[face] >= 0) continue;
        const label c = mesh_.owner()[face], row = c % rows_;
        gradient[face] = (field[mesh_.neighbour()[face]] - field[c])
           /(film(c/rows_)*(middle(row + 1) - middle(row)));
    }
    for (const label patch : {lower(), upper()})
    {
        const labelUList& cells = mesh_.boundary()[patch].faceCells();
        const scalarField& wall = field.boundaryField()[patch];
        forAll(cells, f)
        {
            const label c = cells[f];
            const bool above = patch == upper();
            gradient.boundaryFieldRef()[patch][f] = (above ? 1 : -1)
               *wallGradient(wall[f], field[c], field[second(c, above)])/(film(c/rows_)*share(c % rows_));
        }
    }
    return tgradient;
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmMesh::flatArea() const
{
    auto tarea = tmp<surfaceScalarField>::New
    (
        IOobject("flatArea", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedScalar("zero", dimArea, 0)
    );
    surfaceScalarField& area = tarea.ref();
    // positive where the face's normal points upwards
    area.setOriented();
    forAll(columnFace_, face)
    {
        if (columnFace_[face] < 0) area[face] = length(mesh_.owner()[face]/rows_)*depth;
    }
    for (const label patch : {lower(), upper()})
    {
        const labelUList& cells = mesh_.boundary()[patch].faceCells();
        forAll(cells, f)
        {
            area.boundaryFieldRef()[patch][f] =
                (patch == upper() ? 1 : -1)*length(cells[f]/rows_)*depth;
        }
    }
    return tarea;
}


Foam::tmp<Foam::volScalarField> Foam::filmMesh::field
(
    const word& name,
    const dimensionSet& dimensions,
    const bool fixedInlet
) const
{
    wordList types(mesh_.boundary().size(), zeroGradientFvPatchScalarField::typeName);
    forAll(types, patch)
    {
        if (mesh_.boundary()[patch].type() == emptyFvPatch::typeName)
        {
            types[patch] = emptyFvPatch::typeName;
        }
    }
    if (fixedInlet)
    {
        types[inlet()] = fixedValueFvPatchScalarField::typeName;
    }
    return tmp<volScalarField>::New
    (
        IOobject(name, mesh_.time().timeName(), mesh_, IOobject::NO_READ, IOobject::AUTO_WRITE),
        mesh_,
        dimensionedScalar(name, dimensions, 0),
        types
    );
}
