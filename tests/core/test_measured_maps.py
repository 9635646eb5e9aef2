"""Measured contact maps: series before single maps, each row with its own numbers."""

import xarray as xr

from fractalcontact.core import measured_maps as module
from fractalcontact.core.measured_maps import map_table, measured_maps


def contact_map(series, number, label):
    values = dict.fromkeys(module._COLUMNS.values(), 10.0 * series + number)
    values |= {"series_number": series, "number_in_series": number}
    return xr.Dataset(values, attrs={"series": f"s{series}", "label": label, "threshold": 0.5})


def test_maps_come_by_series_and_by_their_place_in_it():
    maps = {
        "alone": contact_map(3, 1, "c"),
        "late": contact_map(1, 12, "b"),
        "early": contact_map(1, 2, "a"),
        "other": contact_map(2, 1, "d"),
    }
    atlas = xr.DataTree.from_dict({f"contact_maps/{name}": data for name, data in maps.items()})
    found = measured_maps(atlas)
    assert list(found) == ["early", "late", "other", "alone"]
    table = map_table(found)
    assert table["map"].tolist() == list(found)
    assert table["label"].tolist() == ["a", "b", "d", "c"]
    assert table["load_N"].tolist() == [12.0, 22.0, 21.0, 31.0]
    assert set(module._COLUMNS) < set(table)


def test_an_atlas_without_maps_has_none():
    assert measured_maps(xr.DataTree.from_dict({"specimens/rock": xr.Dataset()})) == {}
