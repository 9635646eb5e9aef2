"""The atlas: everything a study made in one netCDF-4 file, a group for each stage and specimen."""

import json

import xarray as xr

from ..core.atomic import atomic_write
from ..core.netcdf import encoding, versions

#: Stages of the atlas, one group each, holding one group a specimen; strength only of joints
#: that slide, roll_off and area_slope one of made surfaces where the study asks.
STAGES = {
    "specimens": "levelled faces, mask, window and where they came from",
    "quality": "relief, spectra and noise floor of each face, and where its fractal range ends",
    "surface_dimension": "Delta_g of each face by several estimators",
    "joints": "offsets and composite topographies",
    "contact": "contact domains",
    "closure": "closure curves, stiffness, real contact area",
    "dilatancy": "rigid and elastic dilatancy",
    "choices": "what was solved and how exactly, why, and the errors that makes",
    "area": "laws of the real contact area, and the classical theories beside it",
    "strength": "dilatancy and friction angles, shear strength",
    "windows": "closure, roughness and strength of parts of the window",
    "domains": "box counts, Delta_sigma and clusters of the contact domains",
    "scaling": "renormalisation over resolutions",
    "domain_measures": "lacunarity and generalised dimensions of the contact at the map offset",
    "size_test": "the direct test of eq. 6, and the whole predicted from its parts",
    "contact_maps": "measured contact maps, one group a map",
    "statements": "what the paper says, and whether it holds here",
    "roll_off": "rigid dilatancy of made joints with and without a roll-off",
    "dimension_test": "both estimates of Delta_sigma on made surfaces",
    "estimator_bias": "estimators of Delta_g on surfaces of known dimension",
    "area_slope": "real contact area at light load, on surfaces with and without a roll-off",
    "speed": "error against time of solvers and cheaper models, one group a scene",
    "speed_growth": "time and memory of the solvers over sizes",
    "convergence": "error against spacing where the solution is known, and Richardson's",
    "stability": "verdicts on the solvers by kind of scene",
    "elimination": "whether dropping points alone reaches the right contact set",
}


def write_atlas(parts, path, *, study, configuration, made_with=None):
    """Put everything a study made into one file.

    Parameters
    ----------
    parts : mapping of str to mapping of str to xr.Dataset
        Stage to specimen to dataset; stages are those of :data:`STAGES`.
    path : path-like
    study : str
        Its name.
    configuration : mapping
        The study's configuration, kept word for word as JSON.
    made_with : mapping of str to mapping of str to dict, optional
        Stage to specimen to the versions each part was made with, from
        :func:`read_with_versions`; those in use by default.

    Returns
    -------
    dict of str to list of str
        Parts by the versions they were made with, where those differ; else empty. The attribute
        ``versions`` then holds those in use, ``versions_differ`` this.

    Raises
    ------
    ValueError
        If a variable has no unit or no long name: nothing unlabelled enters the atlas.
    """
    differing = _by_versions(made_with or {})
    root = xr.Dataset(
        attrs={
            "title": f"fractalcontact study {study}",
            "study": study,
            "configuration": json.dumps(configuration, sort_keys=True),
            "versions": json.dumps(versions()),
            "scan_checksums": json.dumps(_checksums(parts.get("specimens", {})), sort_keys=True),
        }
    )
    if differing:
        root.attrs["versions_differ"] = json.dumps(differing, sort_keys=True)
    groups = {"/": root}
    for stage, specimens in parts.items():
        groups[f"/{stage}"] = xr.Dataset(attrs={"description": STAGES[stage]})
        for name, dataset in specimens.items():
            _demand_labels(dataset, f"{stage}/{name}")
            groups[f"/{stage}/{name}"] = dataset
    with atomic_write(path) as temporary:
        _write_groups(groups, temporary)
    return differing


def _by_versions(made_with):
    """Names of parts by the versions they were made with; none if all are those in use."""
    found = {}
    for stage, specimens in made_with.items():
        for name, known in specimens.items():
            words = ", ".join(f"{library} {version}" for library, version in sorted(known.items()))
            found.setdefault(words or "unknown versions", []).append(f"{stage}/{name}")
    current = ", ".join(f"{library} {version}" for library, version in sorted(versions().items()))
    return {} if set(found) <= {current} else found


class _LastOfAll:
    """Takes note of what is to be written, and writes once every variable of a file is declared.

    Each change from declaring to writing makes the netCDF library go through the whole file: with
    two thousand variables that was nine tenths of the time.
    """

    def __init__(self):
        self.noted = []

    def add(self, source, target, region=None):
        """Called by xarray for each variable."""
        self.noted.append((source, target))

    def write(self):
        """Write everything noted."""
        for source, target in self.noted:
            target[...] = source


def _write_groups(groups, path):
    """Write datasets into the groups of one file, which is opened once.

    ``DataTree.to_netcdf`` opens it again for every group and goes through all that are there.
    """
    import netCDF4

    with netCDF4.Dataset(path, "w") as file:
        writer = _LastOfAll()
        for name, dataset in groups.items():
            group = file if name == "/" else file.createGroup(name)
            backend = xr.backends.NetCDF4DataStore(group)
            dataset.dump_to_store(backend, encoding=encoding(dataset), writer=writer)
        writer.write()


def read_atlas(path, without=()):
    """The atlas as an xarray DataTree, in memory.

    Parameters
    ----------
    path : path-like
    without : sequence of str
        Stages to leave out.

    Returns
    -------
    xr.DataTree

    Notes
    -----
    Group by group, from a file opened once. xarray's ``open_datatree`` ends in a segmentation fault
    inside netCDF4 where a process has opened the same file before, and to open every group for
    itself takes a quarter of a second each, because all the others are gone through.
    """
    import netCDF4

    with netCDF4.Dataset(path) as file:
        groups = {"/": file}
        for name, stage in file.groups.items():
            if name not in without:
                groups |= {g.path: g for g in (stage, *stage.groups.values())}
        loaded = {
            name: xr.open_dataset(xr.backends.NetCDF4DataStore(found)).load()
            for name, found in groups.items()
        }
    return xr.DataTree.from_dict(loaded)


def _checksums(specimens):
    """SHA-256 of every scan file, by specimen and face."""
    return {
        name: {
            face: json.loads(dataset.attrs[f"{face}_scan"])["sha256"]
            for face in ("lower", "upper")
            if f"{face}_scan" in dataset.attrs
        }
        for name, dataset in specimens.items()
    }


def _demand_labels(dataset, where):
    for name, variable in dataset.data_vars.items():
        missing = [key for key in ("units", "long_name") if key not in variable.attrs]
        if missing:
            raise ValueError(f"{where}: variable {name} has no {' and no '.join(missing)}")
