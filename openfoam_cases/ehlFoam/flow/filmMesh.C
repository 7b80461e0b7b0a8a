/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "filmMesh.H"
#include "linear.H"
#include "zeroGradientFvPatchFields.H"
#include "emptyFvPatchFields.H"

namespace Foam
{

//- What is stored of a mesh may be changed: its points move in closed form
template<class Type>
static Type& stored(const Type& value)
{
    return const_cast<Type&>(value);
}

} // End namespace Foam


Foam::filmMesh::filmMesh
(
    const Time& runTime,
    const label columns,
    const label rows,
    const scalar lowerShare
)
:
    block_(columnBlock(runTime, columns, rows)),
    mesh_(*block_),
    columns_(columns),
    rows_(rows),
    lowerShare_(lowerShare),
    level_(rows + 1),
    x_(columns + 1, Zero),
    h_(columns + 1, Zero),
    columnFace_(mesh_.nInternalFaces(), -1),
    faceRow_(mesh_.nInternalFaces(), -1),
    acrossFilm
    (
        IOobject("acrossFilm", runTime.timeName(), mesh_, IOobject::NO_READ, IOobject::NO_WRITE),
        mesh_,
        dimensionedScalar("one", dimless, 1)
    )
{
    forAll(level_, j)
    {
        level_[j] = scalar(j)/rows;
    }

    forAll(columnFace_, face)
    {
        const label owner = mesh_.owner()[face], neighbour = mesh_.neighbour()[face];
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

    // Columns are trapeziums: their geometry in closed form. movePoints would
    // find it by the faces, and the volumes that faces sweep, which nobody reads
    pointField& points = stored(mesh_.points());
    vectorField& areas = stored(mesh_.faceAreas());
    vectorField& faceCentres = stored(mesh_.faceCentres());
    vectorField& centres = stored(mesh_.cellCentres());
    scalarField& volumes = stored(mesh_.cellVolumes());
    const scalar middleZ = 0.5*depth;
    auto put = [&](const label face, const vector& centre, const vector& area)
    {
        faceCentres[face] = centre;
        areas[face] = area;
    };
    forAll(x, k)
    {
        forAll(level_, j)
        {
            const scalar y = (level_[j] - lowerShare_)*h[k];
            points[columnBlockPoint(rows_, k, 0, j)] = vector(x[k], y, 0);
            points[columnBlockPoint(rows_, k, 1, j)] = vector(x[k], y, depth);
        }
    }
    auto columnFace = [&](const label face, const label k, const label j, const scalar side)
    {
        put
        (
            face,
            vector(x[k], (middle(j) - lowerShare_)*h[k], middleZ),
            vector(side*share(j)*h[k]*depth, 0, 0)
        );
    };
    auto rowFace = [&](const label face, const label i, const label j, const scalar side)
    {
        const scalar level = level_[j] - lowerShare_;
        put
        (
            face,
            vector(0.5*(x[i] + x[i + 1]), level*film(i), middleZ),
            side*depth*vector(-level*(h[i + 1] - h[i]), length(i), 0)
        );
    };
    forAll(columnFace_, face)
    {
        const label cell = mesh_.owner()[face];
        if (columnFace_[face] >= 0) columnFace(face, columnFace_[face], faceRow_[face], 1);
        else rowFace(face, cell/rows_, cell % rows_ + 1, 1);
    }
    const polyBoundaryMesh& patches = mesh_.boundaryMesh();
    for (label j = 0; j < rows_; ++j)
    {
        columnFace(patches[inlet()].start() + j, 0, j, -1);
        columnFace(patches[outlet()].start() + j, columns_, j, 1);
    }
    const label flat = patches.findPatchID("frontAndBack");
    for (label i = 0; i < columns_; ++i)
    {
        rowFace(patches[lower()].start() + i, i, 0, -1);
        rowFace(patches[upper()].start() + i, i, rows_, 1);
        const scalar a = h[i], b = h[i + 1];
        const scalar along = x[i] + length(i)*(a + 2*b)/(3*(a + b));
        const scalar across = 2*(sqr(a) + a*b + sqr(b))/(3*(a + b));
        for (label j = 0; j < rows_; ++j)
        {
            const label c = cell(i, j);
            const scalar area = share(j)*film(i)*length(i);
            centres[c] = vector(along, (middle(j) - lowerShare_)*across, middleZ);
            volumes[c] = area*depth;
            const label front = patches[flat].start() + c;
            put(front, vector(centres[c].x(), centres[c].y(), 0), vector(0, 0, -area));
            put(front + mesh_.nCells(), vector(centres[c].x(), centres[c].y(), depth), vector(0, 0, area));
        }
    }
    stored(mesh_.magSf()) = mag(mesh_.Sf());
    mesh_.surfaceInterpolation::movePoints();
}


void Foam::filmMesh::write() const
{
    mesh_.polyMesh::write();
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
    const surfaceScalarField& flux,
    const scalar inletValue
) const
{
    tmp<surfaceScalarField> tface(linear<scalar>(mesh_).interpolate(field));
    surfaceScalarField& value = tface.ref();
    forAll(columnFace_, face)
    {
        const label k = columnFace_[face];
        if (k > 0) value[face] = field[cell(flux[face] < 0 ? k : k - 1, faceRow_[face])];
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
