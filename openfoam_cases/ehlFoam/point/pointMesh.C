/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointMesh.H"
#include "fvcSurfaceIntegrate.H"
#include "polyPatch.H"
#include "surfaceFields.H"
#include "volFields.H"
#include "zeroGradientFvPatchFields.H"


Foam::autoPtr<Foam::fvMesh> Foam::pointMesh
(
    const Time& runTime, const pointFilm& film, const pointFilm::columns& c, const label rows
)
{
    const pointLayout& layout = film.layout();
    const label nx = layout.nx(), ny = layout.ny();
    const scalar length = film.contact().halfWidth, thickness = film.contact().filmUnit();
    auto point = [&](const label k, const label l, const label row)
    {
        return (l*(nx + 1) + k)*(rows + 1) + row;
    };
    pointField points((nx + 1)*(ny + 1)*(rows + 1));
    for (label l = 0; l <= ny; ++l)
    {
        for (label k = 0; k <= nx; ++k)
        {
            const scalar h = thickness*film.cornerFilm(c, k, l);
            for (label row = 0; row <= rows; ++row)
            {
                points[point(k, l, row)] =
                    vector(length*layout.x[k], length*layout.y[l], (scalar(row)/rows - 0.5)*h);
            }
        }
    }
    // normals along +x, +y and +z
    auto alongX = [&](const label k, const label l, const label row)
    {
        return face({point(k, l, row), point(k, l + 1, row), point(k, l + 1, row + 1), point(k, l, row + 1)});
    };
    auto alongY = [&](const label k, const label l, const label row)
    {
        return face({point(k, l, row), point(k, l, row + 1), point(k + 1, l, row + 1), point(k + 1, l, row)});
    };
    auto alongZ = [&](const label k, const label l, const label row)
    {
        return face({point(k, l, row), point(k + 1, l, row), point(k + 1, l + 1, row), point(k, l + 1, row)});
    };
    auto cell = [&](const label i, const label j, const label row) { return layout.cell(i, j)*rows + row; };
    DynamicList<face> faces;
    DynamicList<label> owner, neighbour;
    auto add = [&](const label of, const face& f)
    {
        owner.append(of);
        faces.append(f);
    };
    for (label j = 0; j < ny; ++j)
    {
        for (label i = 0; i < nx; ++i)
        {
            for (label row = 0; row < rows; ++row)
            {
                const label here = cell(i, j, row);
                if (row + 1 < rows)
                {
                    add(here, alongZ(i, j, row + 1));
                    neighbour.append(here + 1);
                }
                if (i + 1 < nx)
                {
                    add(here, alongX(i + 1, j, row));
                    neighbour.append(cell(i + 1, j, row));
                }
                if (j + 1 < ny)
                {
                    add(here, alongY(i, j + 1, row));
                    neighbour.append(cell(i, j + 1, row));
                }
            }
        }
    }
    const wordList names({"inlet", "outlet", "middle", "side", "lower", "upper"});
    const wordList types({"patch", "patch", "symmetryPlane", "patch", "wall", "wall"});
    labelList starts(names.size() + 1);
    for (label side = 0; side < 2; ++side)
    {
        starts[side] = faces.size();
        for (label j = 0; j < ny; ++j)
        {
            for (label row = 0; row < rows; ++row)
            {
                const face f(alongX(side ? nx : 0, j, row));
                add(cell(side ? nx - 1 : 0, j, row), side ? f : f.reverseFace());
            }
        }
    }
    for (label side = 0; side < 2; ++side)
    {
        starts[2 + side] = faces.size();
        for (label i = 0; i < nx; ++i)
        {
            for (label row = 0; row < rows; ++row)
            {
                const face f(alongY(i, side ? ny : 0, row));
                add(cell(i, side ? ny - 1 : 0, row), side ? f : f.reverseFace());
            }
        }
    }
    for (label side = 0; side < 2; ++side)
    {
        starts[4 + side] = faces.size();
        for (label j = 0; j < ny; ++j)
        {
            for (label i = 0; i < nx; ++i)
            {
                const face f(alongZ(i, j, side ? rows : 0));
                add(cell(i, j, side ? rows - 1 : 0), side ? f : f.reverseFace());
            }
        }
    }
    starts.last() = faces.size();

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
        patches[p] = polyPatch::New
        (
            types[p], names[p], starts[p + 1] - starts[p], starts[p], p, mesh->boundaryMesh()
        ).release();
    }
    mesh->addFvPatches(patches);
    return mesh;
}


Foam::scalar Foam::writePointFields
(
    Time& runTime, const pointFilm& film, const pointFilm::state& s, const lubricant& oil, const label rows
)
{
    const pointContact& contact = film.contact();
    const pointLayout& layout = film.layout();
    const label nx = layout.nx(), ny = layout.ny();
    const pointFilm::columns c(film.columnsOf(s));
    pointFilm::faceFluxes fluxes;
    film.residual(s, c, nullptr, &fluxes);
    autoPtr<fvMesh> block(pointMesh(runTime, film, c, rows));
    const fvMesh& mesh = *block;

    // mass fluxes through the faces of the cells [kg/s]
    const scalar length = contact.halfWidth, speed = contact.entrainment();
    const scalar unit = oil.density(0)*speed*contact.filmUnit()*length;
    const scalar slide = (contact.upperSpeed - contact.lowerSpeed)/speed;
    auto level = [&](const label row) { return (row + 0.5)/rows; };
    // of the flux that pressure drives a row has the mean of 6 y (1 - y); of what is dragged, that of both surfaces
    auto parabola = [&](const label row) { return 6*level(row)*(1 - level(row)) - 0.5/sqr(scalar(rows)); };
    auto drag = [&](const label row) { return 1 + slide*(level(row) - 0.5); };
    auto along = [&](const label k, const label j, const label row)
    {
        const scalar width = layout.y[j + 1] - layout.y[j];
        return unit*width/rows*(drag(row)*fluxes.dragged(k, j) + parabola(row)*fluxes.driven(k, j));
    };
    auto across = [&](const label i, const label l, const label row)
    {
        return unit*(layout.x[i + 1] - layout.x[i])/rows*parabola(row)*fluxes.across(i, l);
    };
    surfaceScalarField phi
    (
        IOobject("massFlux", runTime.timeName(), mesh),
        mesh,
        dimensionedScalar("zero", dimMass/dimTime, 0)
    );
    phi.setOriented();
    auto types = [&](const word& others)
    {
        wordList named(mesh.boundary().size(), others);
        named[2] = "symmetryPlane";
        return named;
    };
    auto scalarOf = [&](const word& name, const dimensionSet& dimensions)
    {
        return tmp<volScalarField>::New
        (
            IOobject(name, runTime.timeName(), mesh, IOobject::NO_READ, IOobject::AUTO_WRITE),
            mesh, dimensionedScalar(name, dimensions, 0), types("zeroGradient")
        );
    };
    tmp<volScalarField> tp(scalarOf("p", dimPressure)), tmu(scalarOf("mu", dimDynamicViscosity));
    tmp<volScalarField> trho(scalarOf("rho", dimDensity)), tfraction(scalarOf("liquidFraction", dimless));
    volVectorField U
    (
        IOobject("U", runTime.timeName(), mesh, IOobject::NO_READ, IOobject::AUTO_WRITE),
        mesh, dimensionedVector("U", dimVelocity, Zero), types("zeroGradient")
    );
    scalarField upwards(mesh.nCells(), Zero);
    for (label j = 0; j < ny; ++j)
    {
        for (label i = 0; i < nx; ++i)
        {
            const label m = layout.cell(i, j);
            scalar rising = 0;
            for (label row = 0; row < rows; ++row)
            {
                const label here = m*rows + row;
                tp.ref()[here] = contact.pressure*c.P[m];
                tmu.ref()[here] = oil.viscosity(s.v[m]);
                trho.ref()[here] = c.theta[m]*oil.density(s.v[m]);
                tfraction.ref()[here] = c.theta[m];
                const scalar lack =
                    along(i, j, row) - along(i + 1, j, row) + across(i, j, row) - across(i, j + 1, row);
                const scalar middle = rising + 0.5*lack;
                rising += lack;
                upwards[here] = rising;
                const scalar area = sqr(length)*layout.area(i, j), h = contact.filmUnit()*c.H[m];
                const scalar mass = trho()[here]*h/rows*length;
                U[here] = vector
                (
                    0.5*(along(i, j, row) + along(i + 1, j, row))/(mass*(layout.y[j + 1] - layout.y[j])),
                    0.5*(across(i, j, row) + across(i, j + 1, row))/(mass*(layout.x[i + 1] - layout.x[i])),
                    middle/(trho()[here]*area)
                );
            }
        }
    }
    forAll(mesh.owner(), f)
    {
        const label here = mesh.owner()[f], there = mesh.neighbour()[f], m = here/rows, row = here % rows;
        const label i = m % nx, j = m/nx;
        phi[f] = there == here + 1 ? upwards[here] : there/rows == m + 1 ? along(i + 1, j, row) : across(i, j + 1, row);
    }
    for (const label patch : {0, 1, 3})
    {
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        forAll(cells, f)
        {
            const label m = cells[f]/rows, row = cells[f] % rows, i = m % nx, j = m/nx;
            phi.boundaryFieldRef()[patch][f] =
                patch == 0 ? -along(0, j, row) : patch == 1 ? along(nx, j, row) : across(i, ny, row);
        }
    }
    // by OpenFOAM's own sum over the faces of each cell; nothing goes through the surfaces
    const scalarField lack(fvc::surfaceIntegrate(phi)().primitiveField()*mesh.V());
    scalar worst = 0;
    forAll(lack, here)
    {
        const label j = here/rows/nx;
        worst = max(worst, mag(lack[here])/(unit*film.central(c.H)*(layout.y[j + 1] - layout.y[j])));
    }
    mesh.polyMesh::write();
    for (volScalarField* each : {&tp.ref(), &tmu.ref(), &trho.ref(), &tfraction.ref()})
    {
        each->correctBoundaryConditions();
        each->write();
    }
    U.correctBoundaryConditions();
    for (const label patch : {4, 5})
    {
        U.boundaryFieldRef()[patch] == vector(patch == 4 ? contact.lowerSpeed : contact.upperSpeed, 0, 0);
    }
    U.write();
    // those of controlDict, on these fields
    runTime.functionObjects().execute();
    runTime.functionObjects().end();
    return worst;
}
